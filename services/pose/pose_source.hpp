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
#include "ipc/msg/tracker_faults.hpp"
#include "ipc/shm/open_ring.hpp"
#include "services/joints/conventions.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::pose {

/// The most cameras whose landmarks a source takes: camera and camera2.
inline constexpr int kMostViews = 2;

/// A hand tracker, or what stands in for it. One thread.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// Fills `poses` with the next sample, which may have no hand (count 0); waits for it until the
  /// deadline. Frame ids and origins increase from call to call. Errors: timeout, bad_data (this
  /// sample is lost), disconnected.
  virtual Result<void> sample(msg::HandPoses& poses, Deadline deadline) = 0;

  /// The number of cameras whose landmarks it takes by see().
  virtual int views() const { return 0; }
  /// True if its samples are made from landmarks: none comes without them.
  virtual bool needs_landmarks() const { return views() > 0; }
  /// Of several views: the one whose landmarks the next sample waits for.
  virtual int awaited_view() const { return 0; }
  /// Receives the landmarks of the newest image of a view, 0 to views() - 1. Ignored if views() is
  /// 0.
  virtual void see(const msg::Landmarks& /*landmarks*/, int /*view*/) {}
  /// True if the newest sample depends on the calibration of the camera.
  virtual bool depends_on_calibration() const { return needs_landmarks(); }

  /// Whether it uses settings that change while it is open, and uses those of `rig` from now on.
  /// @{
  virtual bool is_adjustable() const { return false; }
  virtual void adjust(const config::Rig& /*rig*/) {}
  /// @}

  /// What the joints of the samples mean. Constant.
  virtual joints::Conventions conventions() const { return {}; }
  /// What the tracker did wrong since the last call, as far as it was watched.
  virtual msg::TrackerFaults take_faults() { return {}; }
};

/// The rig that is up, as far as back ends need it.
struct Surroundings {
  std::int64_t epoch_ns = 0;  ///< time zero of the rig, CLOCK_MONOTONIC
  ipc::OpenRing ring{};       ///< gives its rings; empty if there is no rig
};

/// A back end, opened with the rig, its calibration and its surroundings.
using PoseBackend = service::Backend<PoseSource, config::Rig, calib::Calibration, Surroundings>;
/// Of a back end that is a file of its own: pose/NAME.so.
extern "C" const service::LoadedBackEnd<PoseBackend> handcast_pose_back_end;

/// All back ends of this build.
std::span<const PoseBackend> pose_backends();

/// Opens the back end rig.pose.backend, watched (WatchedSource), and rig.pose.second, if it is set.
/// Errors: bad_config (unknown back end, or its settings are wrong), and those of the back end.
Result<std::unique_ptr<PoseSource>> open_pose_source(const config::Rig& rig,
                                                     const calib::Calibration& calibration,
                                                     std::int64_t epoch_ns,
                                                     const ipc::OpenRing& ring = {});
/// Whether only one process at a time can have the sources of this rig open.
bool is_exclusive(const config::Pose& settings);
/// Opens the sources of a rig and closes them again, except exclusive ones. Errors: as
/// open_pose_source().
Result<void> check_pose_sources(const config::Rig& rig, const calib::Calibration& calibration);

}  // namespace handcast::pose
