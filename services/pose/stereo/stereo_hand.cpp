// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/stereo_hand.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "services/pose/lift/fit.hpp"
#include "services/pose/stereo/first_fit.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr int kAnewSteps = 20, kSteps = 4;
constexpr int kTryEvery = 8, kTrials = 2;
constexpr double kClearlyBetter = 0.8;
constexpr double kSmooth_s = 0.1;
constexpr double kLost_sigmas = 6;  ///< off by so many, a hand is found anew
/// The least confidence of a hand that only one view sees.
constexpr double kOneViewConfidence = 0.5;

SeenInViews seen_in(const Looks& looks) {
  SeenInViews seen;
  for (int v = 0; v < kViews; ++v)
    if (looks[v]) seen[v] = looks[v]->hand.seen;
  return seen;
}

/// The share of the landmarks that a view sees at least.
double seen_share(const Looks& looks) {
  int seen = 0;
  for (int i = 0; i < msg::kLandmarks; ++i)
    seen += std::ranges::any_of(
        looks, [i](const auto& look) { return look && look->hand.seen.sigma_px[i] > 0; });
  return static_cast<double>(seen) / msg::kLandmarks;
}

/// A posture in which least squares may begin, too.
Posture alternative(int which, const Posture& posture) {
  if (which == 0) return mirrored_in_depth(posture);
  return with_fingers_at_rest(posture);
}

bool all_finite(const msg::HandPose& pose) {
  const auto finite = [](const auto& values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
  };
  return std::ranges::all_of(pose.joints, [&](const auto& joint) {
    return finite(joint.position_m) && finite(joint.orientation_xyzw);
  });
}

}  // namespace

StereoHand::StereoHand(const renderer::HandMesh& hand, const config::PoseStereo& settings,
                       const Views& views, const glm::dmat4& tracker_from_first)
    : skeleton_(hand),
      side_(hand.side),
      views_(views),
      tracker_from_first_(tracker_from_first),
      people_(
          HandTrack::of_people(settings.hand_length_mm > 0
                                   ? std::log(1e-3 * settings.hand_length_mm / skeleton_.length_m())
                                   : 0)),
      one_view_ns_(seconds_to_ns(settings.one_view_s)) {}

bool StereoHand::is_followed(std::int64_t time_ns) const {
  return track_ && std::abs(time_ns - last_ns_) < kForget_ns;
}

std::optional<PosedHand> StereoHand::expected(std::int64_t time_ns) const {
  if (!is_followed(time_ns)) return std::nullopt;
  const auto prior = track_->predicted(std::max(0.0, ns_to_seconds(time_ns - last_ns_)));
  return posed(skeleton_, prior.mean);
}

/// The landmarks of all views, moved by the way that the hand goes in the image between their time
/// and `time_ns`, when it is at `now`.
SeenInViews StereoHand::moved_to(std::int64_t time_ns, const HandState& now,
                                 const Looks& looks) const {
  SeenInViews seen;
  for (int v = 0; v < kViews; ++v) {
    if (!looks[v]) continue;
    seen[v] = looks[v]->hand.seen;
    if (looks[v]->time_ns == time_ns) continue;
    const double share =
        static_cast<double>(looks[v]->time_ns - last_ns_) / static_cast<double>(time_ns - last_ns_);
    Unknowns way = difference(track_->state(), now);
    for (double& step : way) step *= share;
    const PosedHand from = posed(skeleton_, moved(track_->state(), way)),
                    to = posed(skeleton_, now);
    for (int i = 0; i < msg::kLandmarks; ++i) {
      const int joint = msg::kJointOfLandmark[i];
      seen[v]->px[i] +=
          views_[v].project(to.place_m[joint]) - views_[v].project(from.place_m[joint]);
    }
  }
  return seen;
}

std::optional<msg::HandPose> StereoHand::follow(std::int64_t time_ns, const Looks& looks) {
  if (track_ && time_ns <= last_ns_) return std::nullopt;
  if (!looks[0] && !looks[1]) return std::nullopt;
  const bool has_both = looks[0] && looks[1];
  const bool goes_on =
      is_followed(time_ns) && (has_both || time_ns - last_both_ns_ <= one_view_ns_);
  const double step_s = goes_on ? ns_to_seconds(time_ns - last_ns_) : 0;
  if (goes_on)
    go_on(time_ns, looks, step_s);
  else if (!begin(seen_in(looks)))
    return std::nullopt;
  last_ns_ = time_ns;
  if (has_both || !goes_on) last_both_ns_ = time_ns;
  confidence_ = confidence_of(looks);
  const auto pose = pose_of(track_->state(), confidence_);
  if (sigmas_ < kLost_sigmas && all_finite(pose)) return pose;
  forget();
  return std::nullopt;
}

std::optional<msg::HandPose> StereoHand::predict(std::int64_t time_ns) const {
  if (!is_followed(time_ns) || time_ns <= last_ns_) return std::nullopt;
  const std::int64_t since_ns = time_ns - last_ns_;
  const double left = 1 - static_cast<double>(since_ns) / static_cast<double>(kForget_ns);
  return pose_of(track_->predicted(ns_to_seconds(since_ns)).mean, left * confidence_);
}

std::optional<double> StereoHand::cost_anew(const Looks& looks) const {
  const SeenInViews seen = seen_in(looks);
  if (!sees_all(seen)) return std::nullopt;
  const auto anew = first_fit(skeleton_, views_, seen, people_);
  if (!anew) return std::nullopt;
  if (!track_) return anew->cost;
  const HandFit here = fit_views(skeleton_, views_, seen, people_, track_->state(), kAnewSteps);
  return std::min(anew->cost, here.cost);
}

void StereoHand::forget() {
  track_.reset();
  sigmas_ = 1;
}

/// A hand that one view alone sees begins at the distance at which its size is usual. Its pose is
/// the hint by which the detector of the other view finds it.
bool StereoHand::begin(const SeenInViews& seen) {
  const HandPrior prior = track_ ? track_->bones() : people_;
  const auto best = first_fit(skeleton_, views_, seen, prior);
  if (!best) return false;
  track_.emplace(*best);
  sigmas_ = best->sigmas;
  is_whole_ = sees_both(seen);
  images_ = 0;
  better_ = {};
  return true;
}

/// The motion between images of different times is known better once both have been fitted.
void StereoHand::go_on(std::int64_t time_ns, const Looks& looks, double step_s) {
  const HandPrior prior = track_->predicted(step_s);
  SeenInViews seen = moved_to(time_ns, prior.mean, looks);
  HandFit fit = fit_views(skeleton_, views_, seen, prior, prior.mean, kSteps);
  if (sees_both(seen) && looks[0]->time_ns != looks[1]->time_ns) {
    seen = moved_to(time_ns, fit.state, looks);
    fit = fit_views(skeleton_, views_, seen, prior, fit.state, kSteps);
  }
  track_->correct(fit, step_s);
  is_whole_ = is_whole_ || sees_both(seen);
  sigmas_ += (fit.sigmas - sigmas_) * std::min(1.0, step_s / kSmooth_s);
  if (++images_ % kTryEvery == 0 && sees_all(seen)) try_another(seen);
}

/// Least squares may have ended in the wrong posture. In turn, another one is tried now and then,
/// and taken if it is clearly better more than once.
void StereoHand::try_another(const SeenInViews& seen) {
  const HandState& state = track_->state();
  const HandPrior prior = track_->bones();
  const auto fitted = [&](const Posture& posture) {
    const HandState start{posture, state.depth_m, state.log_bone};
    return fit_views(skeleton_, views_, seen, prior, start, kAnewSteps);
  };
  const HandFit here = fitted(state.posture);
  const int which = images_ / kTryEvery % kAlternatives;
  const HandFit there = fitted(alternative(which, state.posture));
  better_[which] = there.cost < kClearlyBetter * here.cost ? better_[which] + 1 : 0;
  if (better_[which] < kTrials) return;
  track_->jump(there);
  better_ = {};
}

/// The detectors' presence, less if the landmarks fit the hand badly or only one view has seen it
/// for a while.
double StereoHand::confidence_of(const Looks& looks) const {
  double presence = 0;
  int count = 0;
  for (const auto& look : looks)
    if (look) presence += look->hand.presence, ++count;
  const double fits = std::clamp(2 / std::max(sigmas_, 1e-3), 0.2, 1.0);
  const double alone_share = static_cast<double>(last_ns_ - last_both_ns_) /
                             static_cast<double>(std::max<std::int64_t>(one_view_ns_, 1));
  const double alone = is_whole_ ? std::clamp(alone_share, 0.0, 1.0) : 1;
  return presence / std::max(count, 1) * seen_share(looks) * fits *
         (1 - (1 - kOneViewConfidence) * alone);
}

msg::HandPose StereoHand::pose_of(const HandState& state, double confidence) const {
  const PosedHand hand = posed(skeleton_, state);
  const double size = std::exp(state.posture.log_size);
  msg::HandPose pose{side_, static_cast<float>(confidence), {}};
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::vec3 place(tracker_from_first_ * glm::dvec4(hand.place_m[j], 1));
    const glm::quat turn(
        glm::normalize(glm::quat_cast(glm::dmat3(tracker_from_first_) * hand.axes[j])));
    pose.joints[j] = {{place.x, place.y, place.z},
                      {turn.x, turn.y, turn.z, turn.w},
                      static_cast<float>(size * skeleton_.radius_m(j))};
  }
  return pose;
}

}  // namespace handcast::pose::stereo
