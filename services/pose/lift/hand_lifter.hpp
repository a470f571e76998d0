// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "config/sections/sensors.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "services/pose/lift/posture_track.hpp"

namespace handcast::pose {

/// Step "lift" for one hand, and its state: the poses of a hand from its landmarks in single
/// images. See `docs/method.md#lift`. One thread.
class HandLifter {
 public:
  /// After so long without landmarks the hand is lifted anew.
  static constexpr std::int64_t kForget_ns = 300'000'000;
  /// A hand with fewer seen landmarks is not lifted.
  static constexpr int kFewestSeen = 8;

  /// `hand`: the model of this side.
  HandLifter(const renderer::HandMesh& hand, const config::PoseNone& settings,
             const calib::Calibration& calibration);

  /// The pose in tracker space of a hand with these landmarks in the image exposed at `time_ns`.
  /// Empty if too few landmarks were seen, they lie too close together, a coordinate is not finite,
  /// the image is not newer than the last one, or no hand can have these landmarks.
  std::optional<msg::HandPose> lift(std::int64_t time_ns, const msg::HandLandmarks& seen);

 private:
  /// Also the size that was learned.
  void forget();
  void begin(const SeenHand& seen);
  void go_on(const SeenHand& seen, double step_s);
  void try_another(const SeenHand& seen);
  void learn_size(double step_s);
  msg::HandPose pose_of(const msg::HandLandmarks& seen) const;

  Skeleton skeleton_;
  msg::Side side_;
  calib::CameraModel camera_;
  glm::dmat4 tracker_from_camera_;
  double distance_m_;
  double usual_log_size_;           ///< of the settings
  std::optional<double> log_size_;  ///< of the person, learned
  double learned_s_ = 0;            ///< how long, up to the time constant
  double log_nearer_ = 0;           ///< size in the image relative to the person's, smoothed
  std::optional<PostureTrack> track_;
  std::int64_t last_ns_ = 0;
  int images_ = 0;  ///< since begin()
  int better_ = 0;  ///< trials in a row in which the other posture was the better one
};

}  // namespace handcast::pose
