// SPDX-License-Identifier: Apache-2.0
#include "services/pose/lift/posture_track.hpp"

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
  for (int i = 0; i < kUnknowns; ++i)
    motion_[i] = MovingUnknown::at_rest(fit.variance[i], motion_of(i).speed);
}

Prior PostureTrack::predict(double step_s) {
  Unknowns step;
  Prior prior;
  for (int i = 0; i < kUnknowns; ++i) {
    step[i] = motion_[i].predict(step_s, motion_of(i).process);
    prior.variance[i] = motion_[i].value_variance;
  }
  posture_ = moved(posture_, step);
  prior.mean = posture_;
  return prior;
}

void PostureTrack::correct(const Fit& fit) {
  const Unknowns shift = difference(posture_, fit.posture);
  for (int i = 0; i < kUnknowns; ++i) motion_[i].correct(shift[i], fit.variance[i]);
  posture_ = fit.posture;
}

void PostureTrack::jump(const Fit& fit) {
  const auto before = motion_;
  *this = PostureTrack(fit);
  for (int i = kPlaceUnknown; i <= kSizeUnknown; ++i) motion_[i].velocity = before[i].velocity;
}

}  // namespace handcast::pose
