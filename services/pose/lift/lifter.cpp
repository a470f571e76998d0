// SPDX-License-Identifier: Apache-2.0
#include "services/pose/lift/lifter.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "services/pose/lift/fit.hpp"

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

namespace {

constexpr int kFirstSteps = 20, kSteps = 5;
/// Added to the landmarks' own variance: bones have other lengths than the model's.
constexpr double kModel_px = 2;
constexpr double kSmallestPalm_px = 10;
constexpr double kSizeSd = 0.02;  ///< of the size while another posture is tried
constexpr double kLearning_s = 20, kDepth_s = 0.1;
constexpr int kTryEvery = 6, kTrials = 2;
constexpr double kClearlyBetter = 0.8;

/// The landmarks with their weights. Empty if too few were seen.
std::optional<SeenHand> read(const msg::HandLandmarks& seen) {
  SeenHand hand;
  int count = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& [x_px, y_px, confidence, sigma_px] = seen.points[i];
    hand.px[i] = {x_px, y_px};
    if (!std::isfinite(x_px) || !std::isfinite(y_px) || !std::isfinite(sigma_px))
      return std::nullopt;
    if (!(confidence > 0)) continue;
    hand.sigma_px[i] = std::hypot(sigma_px, kModel_px) / std::clamp<double>(confidence, 0.2, 1);
    ++count;
  }
  const bool is_large = glm::distance(hand.px[5], hand.px[17]) > kSmallestPalm_px ||
                        glm::distance(hand.px[0], hand.px[9]) > kSmallestPalm_px;
  return count >= HandLifter::kFewestSeen && is_large ? std::optional(hand) : std::nullopt;
}

/// False after landmarks that no hand can have, which may drive the filter apart.
bool is_finite(const msg::HandPose& pose) {
  const auto all_finite = [](const auto& values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
  };
  return std::ranges::all_of(pose.joints, [&](const auto& joint) {
    return all_finite(joint.position_m) && all_finite(joint.orientation_xyzw) &&
           std::isfinite(joint.radius_m);
  });
}

}  // namespace

HandLifter::HandLifter(const renderer::HandMesh& hand, const config::PoseNone& settings,
                       const calib::Calibration& calibration)
    : skeleton_(hand),
      side_(hand.side),
      camera_(calibration.camera),
      tracker_from_camera_(glm::inverse(calibration.camera_from_tracker)),
      distance_m_(settings.distance_m),
      usual_log_size_(settings.hand_length_mm > 0
                          ? std::log(1e-3 * settings.hand_length_mm / skeleton_.length_m())
                          : 0) {}

std::optional<msg::HandPose> HandLifter::lift(std::int64_t time_ns,
                                              const msg::HandLandmarks& landmarks) {
  const auto seen = read(landmarks);
  if (!seen || (track_ && time_ns <= last_ns_)) return std::nullopt;
  const bool goes_on = track_ && time_ns - last_ns_ < kForget_ns;
  const double step_s = goes_on ? ns_to_seconds(time_ns - last_ns_) : 0;
  if (goes_on)
    go_on(*seen, step_s);
  else
    begin(*seen);
  last_ns_ = time_ns;
  learn_size(step_s);
  const auto pose = pose_of(landmarks);
  if (is_finite(pose)) return pose;
  forget();
  return std::nullopt;
}

void HandLifter::forget() {
  track_.reset();
  log_size_.reset();
  learned_s_ = log_nearer_ = 0;
}

void HandLifter::begin(const SeenHand& seen) {
  const Prior prior{.usual_log_size = usual_log_size_};
  const double log_size = log_size_.value_or(usual_log_size_);
  std::optional<Fit> best;
  for (const Posture& start : starts_for(skeleton_, camera_, distance_m_, seen, log_size)) {
    const Fit fit = fit_posture(skeleton_, camera_, distance_m_, seen, prior, start, kFirstSteps);
    if (!best || fit.cost < best->cost) best = fit;
  }
  track_.emplace(*best);
  images_ = better_ = 0;
}

void HandLifter::go_on(const SeenHand& seen, double step_s) {
  Prior prior = track_->predict(step_s);
  prior.usual_log_size = usual_log_size_;
  track_->correct(fit_posture(skeleton_, camera_, distance_m_, seen, prior, prior.mean, kSteps));
  if (++images_ % kTryEvery == 0) try_another(seen);
}

/// Least squares may have ended in the wrong one of two postures, which the image of one moment
/// hardly distinguishes. The other one is tried now and then, and taken if it is clearly better
/// more than once.
void HandLifter::try_another(const SeenHand& seen) {
  const Posture& posture = track_->posture();
  Prior prior{.mean = posture, .usual_log_size = usual_log_size_};
  prior.variance[kSizeUnknown] = kSizeSd * kSizeSd;
  const auto fitted = [&](const Posture& start) {
    return fit_posture(skeleton_, camera_, distance_m_, seen, prior, start, kFirstSteps);
  };
  const Fit here = fitted(posture);
  const Fit there = fitted(images_ % (2 * kTryEvery) == 0 ? mirrored_in_depth(posture)
                                                          : with_fingers_at_rest(posture));
  better_ = there.cost < kClearlyBetter * here.cost ? better_ + 1 : 0;
  if (better_ < kTrials) return;
  track_->jump(there);
  better_ = 0;
}

/// The mean size in the image is that of the person at the set distance. The present one differs
/// from it by the distance, with kDepth_s to keep noise out of the depth.
void HandLifter::learn_size(double step_s) {
  const double log_size = track_->posture().log_size;
  const bool is_new = step_s == 0;
  learned_s_ = std::min(learned_s_ + step_s, kLearning_s);
  if (!log_size_) log_size_ = log_size;
  if (learned_s_ > 0) *log_size_ += (log_size - *log_size_) * step_s / learned_s_;
  const double log_nearer = log_size - *log_size_;
  log_nearer_ += (log_nearer - log_nearer_) * (is_new ? 1 : std::min(1.0, step_s / kDepth_s));
}

/// A hand that is farther away and larger by the same factor has the same image.
msg::HandPose HandLifter::pose_of(const msg::HandLandmarks& seen) const {
  PosedHand hand = skeleton_.posed(track_->posture(), distance_m_);
  const double farther = std::exp(-log_nearer_);
  for (glm::dvec3& place_m : hand.place_m) place_m *= farther;
  msg::HandPose pose{.side = side_, .confidence = seen.presence};
  const double size = farther * std::exp(track_->posture().log_size);
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::vec3 place(tracker_from_camera_ * glm::dvec4(hand.place_m[j], 1));
    const glm::quat turn(
        glm::normalize(glm::quat_cast(glm::dmat3(tracker_from_camera_) * hand.axes[j])));
    pose.joints[j] = {{place.x, place.y, place.z},
                      {turn.x, turn.y, turn.z, turn.w},
                      static_cast<float>(size * skeleton_.radius_m(j))};
  }
  return pose;
}

Result<Lifter> Lifter::open(const config::Rig& rig, const calib::Calibration& calibration) {
  const auto left = renderer::load_hand_or_default(rig.hand.left, msg::Side::left);
  if (!left) return fail_in("left hand", left.error());
  const auto right = renderer::load_hand_or_default(rig.hand.right, msg::Side::right);
  if (!right) return fail_in("right hand", right.error());
  return Lifter({HandLifter(*left, rig.pose.none, calibration),
                 HandLifter(*right, rig.pose.none, calibration)});
}

msg::HandPoses Lifter::lift(const msg::Landmarks& landmarks) {
  msg::HandPoses poses;
  poses.header = {landmarks.header.frame_id, landmarks.header.origin_ns, 0};
  for (const auto side : {msg::Side::left, msg::Side::right})
    if (const auto* seen = landmarks.find(side))
      if (const auto pose =
              hands_[static_cast<std::size_t>(side)].lift(poses.header.origin_ns, *seen))
        poses.hands[poses.count++] = *pose;
  return poses;
}

}  // namespace handcast::pose
