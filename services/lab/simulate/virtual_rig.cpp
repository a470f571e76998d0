// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "services/lab/simulate/exchange.hpp"
#include "services/lab/simulate/recovery.hpp"
#include "services/lab/simulate/score.hpp"

namespace handcast::simulate {
namespace {

struct Chosen {
  const char* setting;
  std::string backend;
  bool can_be_scored;
};

/// The back ends of sensors that the rig uses. Results in a file take the place of a sensor.
std::vector<Chosen> sensors_of(const config::Rig& rig, const Options& options) {
  const auto& tracker = rig.pose.backend;
  const auto by_twin = [](const std::string& backend) { return backend == "twin"; };
  const auto detector = [&](const char* setting, config::Viewpoint at) {
    const auto backend = landmarks::choose_detector(rig, at).backend;
    // Recorded landmarks are of other images.
    return Chosen{setting, backend, backend != "replay" && backend != "external"};
  };
  std::vector<Chosen> all{{"camera.backend", rig.camera.backend, by_twin(rig.camera.backend)}};
  if (options.landmarks_file.empty())
    all.push_back(detector("landmarks.backend", config::Viewpoint::first));
  if (!options.poses_file.empty()) return all;
  all.push_back(
      {"pose.backend", tracker, by_twin(tracker) || tracker == "none" || tracker == "stereo"});
  all.push_back({"pose.second", rig.pose.second, rig.pose.second.empty()});
  if (tracker != "stereo") return all;
  const auto& second = rig.camera2.backend;  // "none": the first camera has two eyes
  all.push_back({"camera2.backend", second, by_twin(second) || second == "none"});
  all.push_back(detector("landmarks2.backend", config::Viewpoint::second));
  return all;
}

/// Gives the messages of the files of the options.
Result<SentMessages> read_sent(const Options& options, const calib::Calibration& calibration) {
  SentMessages sent;
  if (!options.poses_file.empty()) {
    auto poses = read_poses(options.poses_file);
    if (!poses) return tl::make_unexpected(poses.error());
    sent.poses = std::move(*poses);
  }
  if (!options.landmarks_file.empty()) {
    auto landmarks = read_landmarks(options.landmarks_file, calibration.camera);
    if (!landmarks) return tl::make_unexpected(landmarks.error());
    sent.landmarks = std::move(*landmarks);
  }
  return sent;
}

/// Error bad_config: most landmarks are of no image of this run.
Result<void> check_images(const std::vector<SensorEvent>& sent, const twin::Twin& twin) {
  constexpr std::int64_t kLongest_ns = 3'600'000'000'000;
  std::vector<std::int64_t> stamps_ns;
  stamps_ns.reserve(sent.size());
  for (const auto& event : sent)
    stamps_ns.push_back(std::get<msg::Landmarks>(event.message).header.origin_ns);
  std::ranges::sort(stamps_ns);
  std::uint64_t frame = 0;
  std::size_t strange = 0;
  for (const auto stamp_ns : stamps_ns) {
    while (stamp_ns < kLongest_ns && twin.camera_stamp_ns(frame) < stamp_ns) ++frame;
    if (twin.camera_stamp_ns(frame) != stamp_ns) ++strange;
  }
  if (2 * strange < stamps_ns.size()) return {};
  return fail(Errc::bad_config,
              fmt::format("{} of {} landmarks are of no image of this run: give `simulate` the rig "
                          "and the settings that `export-twin` had, camera.rate_hz and twin.seed "
                          "among them",
                          strange, stamps_ns.size()));
}

}  // namespace

Result<void> check_can_be_scored(const config::Rig& rig, const Options& options) {
  std::vector<std::string> chosen, remedies;
  for (const auto& [setting, backend, can_be_scored] : sensors_of(rig, options)) {
    if (can_be_scored) continue;
    chosen.push_back(fmt::format("{} = \"{}\"", setting, backend));
    const bool is_second = setting == std::string_view("pose.second");
    remedies.push_back(fmt::format("--set {}={}", setting, is_second ? "" : "twin"));
  }
  if (chosen.empty()) return {};
  return fail(Errc::bad_config,
              fmt::format("{} cannot be scored in virtual time: it does not see the twin's hand. "
                          "To simulate the rig with the twin's sensors, add {}. To score poses or "
                          "landmarks that another method made of the twin's images (--record), "
                          "add --poses FILE or --landmarks FILE",
                          join(chosen, ", "), join(remedies, " ")));
}

Result<VirtualRig> open_virtual_rig(const config::Rig& rig, const calib::Calibration& calibration,
                                    const Options& options, config::Viewpoint projector) {
  if (auto possible = check_can_be_scored(rig, options); !possible)
    return tl::make_unexpected(possible.error());
  auto sent = read_sent(options, calibration);
  if (!sent) return tl::make_unexpected(sent.error());
  auto twin = twin::Twin::create(rig, calibration);
  if (!twin) return tl::make_unexpected(twin.error());
  if (sent->landmarks)
    if (auto same = check_images(*sent->landmarks, **twin); !same)
      return fail_in(options.landmarks_file, same.error());
  const auto truth = [&world = **twin](renderer::Side side, std::int64_t time_ns) {
    return world.landmarks(side, time_ns);
  };
  auto pipeline = renderer::Pipeline::create(rig.cascade, rig.content, rig.hand,
                                             calib::at_projector(calibration, projector), truth);
  if (!pipeline) return tl::make_unexpected(pipeline.error());
  // With landmarks of a file no detector runs.
  auto detector = sent->landmarks
                      ? Result<std::unique_ptr<FrameDetector>>(make_twin_detector(**twin))
                      : open_frame_detector(rig, calibration, **twin, config::Viewpoint::first);
  if (!detector) return tl::make_unexpected(detector.error());
  VirtualRig parts{std::move(*twin), std::move(*pipeline), std::move(*detector), std::nullopt,
                   nullptr,          std::move(*sent)};
  if (parts.sent.poses) return parts;
  if (rig.pose.backend == "stereo") {
    auto second = SecondView::open(rig, calibration);
    if (!second) return tl::make_unexpected(second.error());
    parts.second = std::move(*second);
  }
  if (rig.pose.backend != "none") return parts;
  auto lifter = pose::Lifter::open(rig, calibration);
  if (!lifter) return tl::make_unexpected(lifter.error());
  parts.lifter = *lifter;
  return parts;
}

Result<void> run_ticks(const Options& options, Simulation& simulation,
                       const std::function<Result<void>(const Tick&)>& on_tick,
                       const OnProgress& on_progress) {
  const auto start_ns = seconds_to_ns(options.warm_up_s),
             end_ns = start_ns + seconds_to_ns(options.seconds);
  Result<void> done;
  while (simulation.now_ns() < end_ns && done) {
    const bool scored = simulation.now_ns() >= start_ns;
    simulation.step([&](const Tick& tick) {
      if (scored && done) done = on_tick(tick);
    });
    if (on_progress) on_progress(ns_to_seconds(simulation.now_ns()));
  }
  return done;
}

Result<std::vector<LightMoment>> moments_without_fault(config::Rig rig,
                                                       const calib::Calibration& calibration,
                                                       const Options& options,
                                                       const OnProgress& on_progress) {
  rig.twin = without_faults(rig.twin);
  auto parts = open_virtual_rig(rig, calibration);
  if (!parts) return tl::make_unexpected(parts.error());
  const auto feed =
      make_twin_feed(*parts->twin, std::move(parts->detector), {}, parts->lifter, parts->second);
  Simulation simulation(rig, calibration, *parts->pipeline, *feed, options.draw_every);
  std::vector<LightMoment> moments;
  const auto add = [&](const Tick& tick) -> Result<void> {
    if (tick.is_new) moments.push_back(moment_of(tick, 0, *parts->twin, calibration));
    return {};
  };
  const auto done = run_ticks(options, simulation, add, on_progress);
  if (!done) return tl::make_unexpected(done.error());
  return moments;
}

}  // namespace handcast::simulate
