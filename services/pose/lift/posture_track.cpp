// SPDX-License-Identifier: Apache-2.0
#include "services/pose/lift/posture_track.hpp"

#include <algorithm>

namespace handcast::pose {
namespace {

/// Process noise: spectral density of the acceleration, unit^2/s^3; and the standard deviation of a
/// velocity that is not known, unit/s.
struct Motion {
  double process, speed;
};
constexpr Motion kTurn{40, 8}, kPlace{0.6, 1}, kSize{0.1, 0.5}, kAngle{80, 10};

constexpr Motion motion_of(int unknown) {
  if (unknown < kPlaceUnknown) return kTurn;
  if (unknown < kSizeUnknown) return kPlace;
  return unknown == kSizeUnknown ? kSize : kAngle;
}

}  // namespace

PostureTrack::PostureTrack(const Fit& fit) : posture_(fit.posture) {
  for (int i = 0; i < kUnknowns; ++i) {
    const double speed = motion_of(i).speed;
    spread_[i] = {fit.variance[i], 0, speed * speed};
  }
}

Prior PostureTrack::predict(double step_s) {
  Unknowns step;
  Prior prior;
  for (int i = 0; i < kUnknowns; ++i) {
    const double q = motion_of(i).process;
    auto& [value, both, velocity] = spread_[i];
    value += step_s * (2 * both + step_s * (velocity + q * step_s / 3));
    both += step_s * (velocity + q * step_s / 2);
    velocity += q * step_s;
    step[i] = velocity_[i] * step_s;
    prior.variance[i] = value;
  }
  posture_ = moved(posture_, step);
  prior.mean = posture_;
  return prior;
}

/// The fit has used the prior, so its shift from the mean is the gain times the innovation, and its
/// variance that of the corrected value.
void PostureTrack::correct(const Fit& fit) {
  const Unknowns shift = difference(posture_, fit.posture);
  for (int i = 0; i < kUnknowns; ++i) {
    auto& [value, both, velocity] = spread_[i];
    const double remains = std::clamp(fit.variance[i] / value, 0.0, 1.0), share = both / value;
    velocity_[i] += share * shift[i];
    velocity -= share * both * (1 - remains);
    both *= remains;
    value *= remains;
  }
  posture_ = fit.posture;
}

void PostureTrack::jump(const Fit& fit) {
  const Unknowns velocity = velocity_;
  *this = PostureTrack(fit);
  for (int i = kPlaceUnknown; i <= kSizeUnknown; ++i) velocity_[i] = velocity[i];
}

}  // namespace handcast::pose
