// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/pose/lift/moving_unknown.hpp"
#include "services/pose/stereo/fit_views.hpp"

namespace handcast::pose::stereo {

/// A hand over time: a constant-velocity Kalman filter on each moving unknown, as if they were
/// independent, and the lengths of the bones, which are learned and then kept. One thread.
class HandTrack {
 public:
  /// The prior of a hand of which nothing is known but the size of people's hands.
  static HandPrior of_people(double log_size);

  /// Begins with a fit; the velocity is unknown.
  explicit HandTrack(const HandFit& fit);

  /// What is known at the time `step_s` after the last correct(), for fit_views().
  HandPrior predicted(double step_s) const;
  /// Takes a fit with the prior predicted(step_s).
  void correct(const HandFit& fit, double step_s);
  /// Takes a fit that contradicts the track: the posture jumps, place and velocities are kept.
  void jump(const HandFit& fit);

  /// The state at the last correct().
  const HandState& state() const { return state_; }
  /// The lengths of the bones, as a prior for a hand that comes back.
  HandPrior bones() const;

 private:
  void predict(double step_s);
  void learn_bones(const HandFit& fit, double step_s);

  HandState state_;
  std::array<MovingUnknown, kMoving> motion_;
  Unknowns bone_variance_{};  ///< of the size and the bones; 0 for the rest
};

}  // namespace handcast::pose::stereo
