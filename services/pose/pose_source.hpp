// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::pose {

/// A hand tracker. One thread.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// Fills `poses` with the next sample, also where it sees no hand (count 0); waits for one until
  /// the deadline. Ids and origins increase from call to call. Errors: timeout, bad_data (this
  /// sample is lost), disconnected.
  virtual Result<void> sample(msg::HandPoses& poses, Deadline deadline) = 0;
};

/// Opened with the rig, its calibration and its epoch (ns).
using PoseBackend = service::Backend<PoseSource, config::Rig, calib::Calibration, std::int64_t>;

std::span<const PoseBackend> pose_backends();

/// Opens the back end that rig.pose.backend names.
Result<std::unique_ptr<PoseSource>> open_pose_source(const config::Rig& rig,
                                                     const calib::Calibration& calibration,
                                                     std::int64_t epoch_ns);

}  // namespace handcast::pose
