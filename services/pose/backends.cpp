// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "config/sections/twin/world_settings.hpp"
#include "services/pose/pair_source.hpp"
#include "services/pose/watched_source.hpp"

namespace handcast::pose {

Result<std::unique_ptr<PoseSource>> open_twin(const config::Rig&, const calib::Calibration&,
                                              const Surroundings&);
Result<std::unique_ptr<PoseSource>> open_replay(const config::Rig&, const calib::Calibration&,
                                                const Surroundings&);
Result<std::unique_ptr<PoseSource>> open_none(const config::Rig&, const calib::Calibration&,
                                              const Surroundings&);
Result<std::unique_ptr<PoseSource>> open_openxr(const config::Rig&, const calib::Calibration&,
                                                const Surroundings&);
Result<void> check_openxr(const config::Rig&, const calib::Calibration&, const Surroundings&);
Result<std::unique_ptr<PoseSource>> open_leapc(const config::Rig&, const calib::Calibration&,
                                               const Surroundings&);
Result<void> check_leapc(const config::Rig&, const calib::Calibration&, const Surroundings&);
Result<std::unique_ptr<PoseSource>> open_external(const config::Rig&, const calib::Calibration&,
                                                  const Surroundings&);
Result<std::unique_ptr<PoseSource>> open_stereo(const config::Rig&, const calib::Calibration&,
                                                const Surroundings&);

static constexpr std::array kBackends{
    PoseBackend{.name = "twin",
                .sentence = "Models a hand tracker that watches the twin's hand.",
                .open = open_twin,
                .reads = config::kTwinWorldSettings + config::SettingList{"twin.tracker"}},
    PoseBackend{.name = "replay",
                .sentence = "Plays a recording of hand poses.",
                .open = open_replay,
                .reads = {"pose.replay"}},
    PoseBackend{.name = "leapc",
                .sentence = "A Leap Motion or Ultraleap device, by Ultraleap's service.",
                .open = open_leapc,
                .reads = {"pose.leapc"},
                .check = check_leapc},
    PoseBackend{.name = "external",
                .sentence = "A program of your own, in any language, by handcast.h.",
                .open = open_external,
                .check = service::kSeenWhenUp},
    PoseBackend{.name = "none",
                .sentence = "No tracker: lifts the landmarks of the camera image to poses.",
                .open = open_none,
                .reads = {"pose.none", "hand"}},
#ifdef HANDCAST_WITH_OPENXR
    PoseBackend{.name = "openxr",
                .sentence = "The hand tracker of an OpenXR runtime.",
                .open = open_openxr,
                .reads = {"pose.openxr"},
                .exclusive = true,
                .check = check_openxr},
#endif
    PoseBackend{.name = "stereo",
                .sentence = "A tracker of our own: makes poses from the landmarks of two cameras.",
                .open = open_stereo,
                .reads = {"pose.stereo", "hand", "camera.backend", "camera2.backend"}},
};

std::span<const PoseBackend> pose_backends() { return kBackends; }

namespace {

std::string title_of(const std::string& name) { return fmt::format("pose '{}'", name); }

Result<std::unique_ptr<WatchedSource>> open_watched(const std::string& name, const config::Rig& rig,
                                                    const calib::Calibration& calibration,
                                                    const Surroundings& around) {
  auto source = service::open_backend("pose", name, pose_backends(), rig, calibration, around);
  if (!source) return tl::make_unexpected(source.error());
  return std::make_unique<WatchedSource>(title_of(name), std::move(*source));
}

Result<void> check_second(const config::Pose& settings) {
  if (settings.second != settings.backend) return {};
  return fail(Errc::bad_config,
              fmt::format("pose.second = \"{}\": this is pose.backend; a second source must be "
                          "another back end",
                          settings.second));
}

}  // namespace

Result<std::unique_ptr<PoseSource>> open_pose_source(const config::Rig& rig,
                                                     const calib::Calibration& calibration,
                                                     std::int64_t epoch_ns,
                                                     const ipc::OpenRing& ring) {
  const auto opener = [&](const std::string& name) {
    return [name, rig, calibration, around = Surroundings{epoch_ns, ring}] {
      return open_watched(name, rig, calibration, around);
    };
  };
  if (rig.pose.second.empty()) return opener(rig.pose.backend)();
  if (auto differs = check_second(rig.pose); !differs) return tl::make_unexpected(differs.error());
  const auto part = [&](const std::string& name) { return PairPart{title_of(name), opener(name)}; };
  return open_pair(rig.pose.handover,
                   {.first = part(rig.pose.backend), .second = part(rig.pose.second)});
}

bool is_exclusive(const config::Pose& settings) {
  return service::is_exclusive("pose", settings.backend, pose_backends()) ||
         service::is_exclusive("pose", settings.second, pose_backends());
}

Result<void> check_pose_sources(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto check = [&](const std::string& name) {
    return service::check_backend("pose", name, pose_backends(), rig, calibration,
                                  Surroundings{now_ns()});
  };
  if (auto first = check(rig.pose.backend); !first || rig.pose.second.empty()) return first;
  if (auto differs = check_second(rig.pose); !differs) return differs;
  return check(rig.pose.second);
}

}  // namespace handcast::pose
