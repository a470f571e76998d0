// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "config/rig.hpp"
#include "config/sections/sensors.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/pose/lift/fit.hpp"
#include "services/pose/lift/moving_unknown.hpp"

namespace handcast::pose {

/// The posture of a hand over time: a constant-velocity Kalman filter on each unknown of a fit, as
/// if they were independent. One thread.
class PostureTrack {
 public:
  /// Begins with a fit; the velocity is unknown.
  explicit PostureTrack(const Fit& fit);

  /// Moves on by `step_s`. Returns what is known of the posture then, for fit_posture().
  Prior predict(double step_s);
  /// Takes a fit with the prior of the last predict().
  void correct(const Fit& fit);
  /// Takes a fit that contradicts the track: postures jump, velocities are kept.
  void jump(const Fit& fit);

  /// The posture at the last correct().
  const Posture& posture() const { return posture_; }

 private:
  Posture posture_;
  std::array<MovingUnknown, kUnknowns> motion_;
};

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

/// Lifts the landmarks of both hands. The pose service and the simulator call it. One thread.
class Lifter {
 public:
  /// Loads the hand models of the rig. Errors: those of load_hand_or_default().
  static Result<Lifter> open(const config::Rig& rig, const calib::Calibration& calibration);

  /// The hands of a detection, in tracker space, with its frame id and origin. Hands that cannot be
  /// lifted are left out.
  msg::HandPoses lift(const msg::Landmarks& landmarks);

 private:
  explicit Lifter(const std::array<HandLifter, msg::kMaxHands>& hands) : hands_(hands) {}

  std::array<HandLifter, msg::kMaxHands> hands_;  ///< by msg::Side
};

}  // namespace handcast::pose
