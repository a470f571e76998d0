// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/hand_track.hpp"

#include <algorithm>

namespace handcast::pose::stereo {
namespace {

/// Process noise: spectral density of the acceleration, unit^2/s^3; and the standard deviation of a
/// velocity that is not known, unit/s.
struct Motion {
  double process, speed;
};
constexpr Motion kTurn{100, 8}, kPlace{20, 1}, kAngle{800, 10};

constexpr Motion motion_of(int unknown) {
  return unknown < kPlaceAt ? kTurn : unknown < kAnglesAt ? kPlace : kAngle;
}

/// People's hands: standard deviations of the logarithms of size and bones.
constexpr double kSizeSd = 0.12, kBoneSd = 0.06;
/// A detector's errors last: images within this time count as one for the lengths of the bones.
constexpr double kErrorsLast_s = 0.4;
/// The lengths stay open to correction by so much, so that an error of the first seconds is
/// forgotten, standard deviations.
constexpr double kLeastSd = 0.004;

}  // namespace

HandPrior HandTrack::of_people(double log_size) {
  HandPrior prior;
  prior.mean.posture.log_size = log_size;
  prior.variance[kSizeAt] = kSizeSd * kSizeSd;
  for (int i = kBonesAt; i < kUnknowns; ++i) prior.variance[i] = kBoneSd * kBoneSd;
  return prior;
}

HandTrack::HandTrack(const HandFit& fit) : state_(fit.state) {
  for (int i = 0; i < kMoving; ++i)
    motion_[i] = MovingUnknown::at_rest(fit.variance[i], motion_of(i).speed);
  for (int i = kMoving; i < kUnknowns; ++i) bone_variance_[i] = fit.variance[i];
}

HandPrior HandTrack::bones() const {
  HandPrior prior;
  prior.mean = state_;
  prior.variance = bone_variance_;
  return prior;
}

void HandTrack::predict(double step_s) {
  Unknowns step{};
  for (int i = 0; i < kMoving; ++i) step[i] = motion_[i].predict(step_s, motion_of(i).process);
  state_ = moved(state_, step);
}

HandPrior HandTrack::predicted(double step_s) const {
  HandTrack later = *this;
  later.predict(step_s);
  HandPrior prior{later.state_, bone_variance_};
  for (int i = 0; i < kMoving; ++i) prior.variance[i] = later.motion_[i].value_variance;
  return prior;
}

void HandTrack::correct(const HandFit& fit, double step_s) {
  predict(step_s);
  const Unknowns shift = difference(state_, fit.state);
  for (int i = 0; i < kMoving; ++i) motion_[i].correct(shift[i], fit.variance[i]);
  const HandState before = state_;
  state_ = fit.state;
  state_.posture.log_size = before.posture.log_size;
  state_.log_bone = before.log_bone;
  learn_bones(fit, step_s);
}

/// Takes only that share of the fit's information that is new in `step_s`.
void HandTrack::learn_bones(const HandFit& fit, double step_s) {
  const Unknowns shift = difference(state_, fit.state);
  const double share = std::min(1.0, step_s / kErrorsLast_s);
  Unknowns step{};
  for (int i = kMoving; i < kUnknowns; ++i) {
    const double known = 1 / bone_variance_[i];
    const double added = std::max(0.0, 1 / std::max(fit.variance[i], 1e-12) - known);
    if (added <= 0) continue;
    // The fit's mean weighs prior and images by `known` and `added`: what the images alone say.
    const double seen = shift[i] * (known + added) / added;
    step[i] = seen * share * added / (known + share * added);
    bone_variance_[i] = std::max(1 / (known + share * added), kLeastSd * kLeastSd);
  }
  state_ = moved(state_, step);
}

void HandTrack::jump(const HandFit& fit) {
  const auto before = motion_;
  const HandPrior kept = bones();
  *this = HandTrack(fit);
  for (int i = kPlaceAt; i < kAnglesAt; ++i) motion_[i].velocity = before[i].velocity;
  state_.posture.log_size = kept.mean.posture.log_size;
  state_.log_bone = kept.mean.log_bone;
  bone_variance_ = kept.variance;
}

}  // namespace handcast::pose::stereo
