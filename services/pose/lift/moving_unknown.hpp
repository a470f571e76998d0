// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

namespace handcast::pose {

/// What a track knows about one unknown of a fit besides its value: the velocity, and the
/// covariance of both (a Kalman filter with white noise of the acceleration).
struct MovingUnknown {
  double velocity = 0;  ///< mean, unit/s
  double value_variance = 0, covariance = 0, velocity_variance = 0;

  /// Unknown motion: `speed` is the standard deviation of the velocity, unit/s.
  static MovingUnknown at_rest(double variance, double speed) {
    return {0, variance, 0, speed * speed};
  }
  /// Goes on by `step_s`; returns the shift of the value. `process`: spectral density of the
  /// acceleration, unit^2/s^3.
  double predict(double step_s, double process) {
    value_variance +=
        step_s * (2 * covariance + step_s * (velocity_variance + process * step_s / 3));
    covariance += step_s * (velocity_variance + process * step_s / 2);
    velocity_variance += process * step_s;
    return velocity * step_s;
  }
  /// Takes a fit that has used the value and its variance as a prior: its `shift` from that value
  /// is the gain times the innovation, and its variance that of the corrected value.
  void correct(double shift, double variance) {
    const double remains = std::clamp(variance / value_variance, 0.0, 1.0);
    const double share = covariance / value_variance;
    velocity += share * shift;
    velocity_variance -= share * covariance * (1 - remains);
    covariance *= remains;
    value_variance *= remains;
  }
};

}  // namespace handcast::pose
