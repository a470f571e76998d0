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
#include "ipc/msg/landmarks.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::pose {

/// A hand tracker, or what stands in for it. One thread.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// Fills `poses` with the next sample, which may have no hand (count 0); waits for it until the
  /// deadline. Frame ids and origins increase from call to call. Errors: timeout, bad_data (this
  /// sample is lost), disconnected.
  virtual Result<void> sample(msg::HandPoses& poses, Deadline deadline) = 0;

  /// True if the samples are made from landmarks: those that were passed to see() before.
  virtual bool needs_landmarks() const { return false; }
  /// Receives the landmarks of the newest image. Ignored if needs_landmarks() is false.
  virtual void see(const msg::Landmarks&) {}
};

/// A back end, opened with the rig, its calibration, and the epoch of the rig (CLOCK_MONOTONIC,
/// ns).
using PoseBackend = service::Backend<PoseSource, config::Rig, calib::Calibration, std::int64_t>;

/// All back ends of this build.
std::span<const PoseBackend> pose_backends();

/// Opens the back end rig.pose.backend. Errors: bad_config (unknown back end, or its settings are
/// wrong), and those of the back end.
Result<std::unique_ptr<PoseSource>> open_pose_source(const config::Rig& rig,
                                                     const calib::Calibration& calibration,
                                                     std::int64_t epoch_ns);

}  // namespace handcast::pose
