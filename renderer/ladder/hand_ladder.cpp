// SPDX-License-Identifier: Apache-2.0
#include "renderer/ladder/hand_ladder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handcast::renderer {
namespace {

/// Share of a new detection in the means: they reach back some tenths of a second.
constexpr float kInnovationGain = 0.1f;
/// Share of the variance of a detection that passes the offset filter in its steady state.
constexpr float kLeastLandmark = 0.35f;
constexpr std::array kModelled{Rung::shift, Rung::similarity, Rung::fingers};

float mean_square(const LandmarkPoints& p, const LandmarkPoints& q) {
  return residual_px2({}, p, q);
}

/// Mean square error of a detection, without its outliers and wrong fingers: estimated from the
/// median, which for normal errors in the plane is ln 2 times the mean square. Empty if nothing was
/// seen.
std::optional<float> square_px2(const msg::HandLandmarks& seen, const LandmarkPoints& expected) {
  std::array<float, kLandmarks> squares;
  int count = 0;
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::vec2 off = position_px(seen.points[i]) - expected[i];
    if (was_seen(seen.points[i]) && std::isfinite(off.x) && std::isfinite(off.y))
      squares[count++] = glm::dot(off, off);
  }
  if (count == 0) return std::nullopt;
  std::nth_element(squares.begin(), squares.begin() + count / 2, squares.begin() + count);
  return squares[count / 2] / std::numbers::ln2_v<float>;
}

void follow(std::optional<float>& smooth, std::optional<float> value) {
  if (value) smooth = smooth ? *smooth + kInnovationGain * (*value - *smooth) : *value;
}

}  // namespace

HandLadder::HandLadder(const config::Cascade& settings) : gate_(settings.ladder) {
  adjust(settings);
}

void HandLadder::adjust(const config::Cascade& settings) {
  settings_ = settings;
  automatic_ = settings.ladder.rung == config::RungChoice::automatic;
  fixed_ = held_rung(settings.ladder.rung);
  with_tracker_ = moves_with_tracker(settings.filter);
  gate_.adjust(settings.ladder);
}

void HandLadder::detection(const HandTrack& track, std::int64_t origin_ns,
                           const msg::HandLandmarks& seen) {
  if (!automatic_ || !offset_) return;
  const auto then = track.landmarks_at(origin_ns);
  if (then && with_tracker_) follow(innovation_px2_, square_px2(seen, sum(*then, *offset_)));
  if (!with_tracker_) {
    const auto lit = lit_.at(origin_ns);
    if (then && lit) follow(tracker_px2_, square_px2(seen, *then));
    if (then && lit) follow(innovation_px2_, square_px2(seen, *lit));
  }
}

void HandLadder::judge_landmarks(Evidence& evidence) const {
  const auto noise_px = static_cast<float>(settings_.filter.noise_px);
  const float detection_px2 = 2 * noise_px * noise_px;
  const float off_px2 = std::max(innovation_px2_.value_or(2 * detection_px2) - detection_px2,
                                 kLeastLandmark * detection_px2);
  if (settings_.filter.method == config::FilterMethod::ideal) {
    evidence.landmark_px2 = 0;
    evidence.lag_px2 = 0;
  } else if (with_tracker_) {
    evidence.landmark_px2 = off_px2;
  } else {
    // The error is noise and lag. Most of it is common to all landmarks, so a rung with fewer
    // numbers follows as much of it; P does not share it.
    evidence.landmark_px2 = kLeastLandmark * detection_px2;
    evidence.lag_px2 = off_px2;
    if (tracker_px2_)
      evidence.left_px2[0] = evidence.left_px2[1] = std::max(*tracker_px2_ - detection_px2, 0.0f);
  }
}

Corrected HandLadder::take(const HandTrack& track, std::int64_t target_ns,
                           std::optional<std::int64_t> camera_ns, const Predicted& predicted,
                           const Filtered& filtered) {
  Corrected hand{.posed = predicted.posed,
                 .landmarks = filtered.landmarks,
                 .has_landmarks = filtered.has_landmarks,
                 .is_alone = filtered.is_alone,
                 .has_news = filtered.has_news,
                 .registered = 0};
  if (hand.is_alone) {
    *this = HandLadder(settings_);  // its means hold for the tracker before the silence
    return hand;
  }
  if (!automatic_ && fixed_ >= Rung::landmarks) {
    hand.rung = fixed_;
    hand.registered = fixed_ == Rung::registered ? 1.0f : 0.0f;
    return hand;
  }
  const auto newest = track.projected_at(track.newest_ns());
  if (!newest) return hand;
  hand.rung = automatic_ ? choose(track, target_ns, camera_ns, hand, *newest) : fixed_;
  if (!automatic_ && hand.has_landmarks)
    models_[static_cast<std::size_t>(hand.rung)] =
        fit_rung(hand.rung, hand.posed.landmarks, hand.landmarks);
  blend_.turn_to(hand.rung, target_ns, automatic_ ? settings_.filter.blend_ms : 0);
  apply(*newest, hand);
  // Landmarks that are blended must move the drawing, which takes at least a shift.
  const Rung least = hand.has_landmarks ? Rung::shift : Rung::hold;
  if (blend_.is_pure(hand.rung)) hand.moves = std::clamp(hand.rung, least, Rung::landmarks);
  hand.registered = blend_.share(Rung::registered);
  return hand;
}

Rung HandLadder::choose(const HandTrack& track, std::int64_t target_ns,
                        std::optional<std::int64_t> camera_ns, const Corrected& hand,
                        const ProjectedPose& newest) {
  const LandmarkPoints& tracker = hand.posed.landmarks;
  hindsight_.look_back(track);
  if (hindsight_.wants(target_ns)) {
    const auto seen = camera_ns ? track.landmarks_at(*camera_ns) : std::nullopt;
    hindsight_.remember({target_ns, camera_ns.value_or(track.newest_ns()), track.newest_ns(),
                         newest.landmarks, seen.value_or(tracker), tracker});
  }
  const auto& [hold_px, predict_px, register_px] = hindsight_.motion();
  Evidence evidence{std::max(hold_px * hold_px, mean_square(newest.landmarks, tracker)),
                    predict_px * predict_px, register_px * register_px};
  evidence.has_landmarks = hand.has_landmarks;
  evidence.can_register = camera_ns.has_value();
  if (!hand.has_landmarks) {
    models_ = {};
    offset_.reset();
    innovation_px2_.reset();
    tracker_px2_.reset();
    return gate_.choose(target_ns, evidence);
  }
  offset_ = hand.offset_px();
  if (!with_tracker_) lit_.remember(target_ns, hand.landmarks);
  evidence.left_px2.fill(0);
  evidence.left_px2[0] = evidence.left_px2[1] = mean_square(tracker, hand.landmarks);
  judge_landmarks(evidence);
  for (const Rung rung : kModelled) {
    auto& model = models_[static_cast<std::size_t>(rung)] = fit_rung(rung, tracker, hand.landmarks);
    evidence.left_px2[static_cast<std::size_t>(rung)] =
        residual_px2(model, tracker, hand.landmarks);
  }
  return gate_.choose(target_ns, evidence);
}

void HandLadder::apply(const ProjectedPose& newest, Corrected& hand) const {
  // On a low rung that was chosen, not set, the landmarks stay valid: through them the jumps of the
  // tracker are blended.
  const bool goes_on = automatic_ && hand.has_landmarks;
  if (blend_.is_pure(Rung::hold)) {
    if (!goes_on) hand.posed = newest;
    hand.landmarks = newest.landmarks;
    hand.has_landmarks = goes_on;
    return;
  }
  if (blend_.is_pure(Rung::predict)) {
    hand.landmarks = hand.posed.landmarks;
    hand.has_landmarks = goes_on;
    return;
  }
  const float held = blend_.share(Rung::hold), predicted = blend_.share(Rung::predict);
  const float full = blend_.share(Rung::landmarks) + blend_.share(Rung::registered);
  if (full == 1) return;
  LandmarkPoints mixed{};
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::vec2 p = hand.posed.landmarks[i];
    mixed[i] = held * newest.landmarks[i] + predicted * p + full * hand.landmarks[i];
    for (const Rung rung : kModelled)
      if (blend_.share(rung) > 0)
        mixed[i] += blend_.share(rung) * models_[static_cast<std::size_t>(rung)].moved(i, p);
  }
  if (!hand.has_landmarks && held == 0) return;
  hand.landmarks = mixed;
  hand.has_landmarks = true;
}

}  // namespace handcast::renderer
