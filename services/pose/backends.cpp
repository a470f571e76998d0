// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "services/evaluation/twin/settings.hpp"
#include "services/pose/pose_source.hpp"

namespace handcast::pose {

Result<std::unique_ptr<PoseSource>> open_twin(const config::Rig&, const calib::Calibration&,
                                              const std::int64_t& epoch_ns);
Result<std::unique_ptr<PoseSource>> open_replay(const config::Rig&, const calib::Calibration&,
                                                const std::int64_t& epoch_ns);
Result<std::unique_ptr<PoseSource>> open_none(const config::Rig&, const calib::Calibration&,
                                              const std::int64_t& epoch_ns);

static constexpr std::array kBackends{
    PoseBackend{.name = "twin",
                .sentence = "Models a hand tracker that watches the twin's hand.",
                .open = open_twin,
                .reads = twin::kWorldSettings + config::SettingList{"twin.tracker"}},
    PoseBackend{.name = "replay",
                .sentence = "Plays a recording of hand poses.",
                .open = open_replay,
                .reads = {"pose.replay"}},
    PoseBackend{.name = "none",
                .sentence = "No tracker: lifts the landmarks of the camera image to poses.",
                .open = open_none,
                .reads = {"pose.none", "hand"}},
};

std::span<const PoseBackend> pose_backends() { return kBackends; }

Result<std::unique_ptr<PoseSource>> open_pose_source(const config::Rig& rig,
                                                     const calib::Calibration& calibration,
                                                     std::int64_t epoch_ns) {
  return service::open_backend("pose", rig.pose.backend, pose_backends(), rig, calibration,
                               epoch_ns);
}

}  // namespace handcast::pose
