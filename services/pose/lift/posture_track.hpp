// SPDX-License-Identifier: Apache-2.0
#pragma once
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

}  // namespace handcast::pose
