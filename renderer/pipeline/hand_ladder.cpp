#include "renderer/pipeline/hand_ladder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handcast::renderer {
namespace {

constexpr float kInnovationGain = 0.1f;  ///< of each detection: some tenths of a second are remembered
/// As a share of its square: so much of a detection's noise the offset filter lets through in its steady state.
constexpr float kLeastLandmark = 0.35f;
constexpr std::array kModelled{Rung::shift, Rung::similarity, Rung::fingers};

float mean_square(const LandmarkPoints& p, const LandmarkPoints& q) { return residual_px2({}, p, q); }

LandmarkPoints moved(LandmarkPoints points, const LandmarkPoints& by_px) {
  for (int i = 0; i < kLandmarks; ++i) points[i] += by_px[i];
  return points;
}

/// Mean square of what a detection is off by, were there no outliers and no wrong fingers; nothing where nothing was seen.
std::optional<float> square_px2(const msg::HandLandmarks& seen, const LandmarkPoints& expected) {
  std::array<float, kLandmarks> squares;
  int count = 0;
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::vec2 off = position_px(seen.points[i]) - expected[i];
    if (was_seen(seen.points[i]) && std::isfinite(off.x) && std::isfinite(off.y)) squares[count++] = glm::dot(off, off);
  }
  if (count == 0) return std::nullopt;
  std::nth_element(squares.begin(), squares.begin() + count / 2, squares.begin() + count);
  return squares[count / 2] / std::numbers::ln2_v<float>;
}

void follow(std::optional<float>& smooth, std::optional<float> value) {
  if (value) smooth = smooth ? *smooth + kInnovationGain * (*value - *smooth) : *value;
}

}  // namespace

HandLadder::HandLadder(const config::Cascade& settings, const calib::Calibration& calibration)
    : settings_(settings),
      calibration_(calibration),
      automatic_(settings.ladder.rung == "auto"),
      fixed_(rung_named(settings.ladder.rung)),
      with_tracker_(moves_with_tracker(settings.filter)),
      gate_(settings.ladder),
      hindsight_(calibration) {}

void HandLadder::detection(const HandTrack& track, std::int64_t origin_ns, const msg::HandLandmarks& seen) {
  if (!automatic_ || !offset_) return;
  const auto pose = track.pose_at(origin_ns);
  const auto then = pose ? project_landmarks(calibration_, *pose) : std::nullopt;
  if (then && with_tracker_) follow(innovation_px2_, square_px2(seen, moved(*then, *offset_)));
  if (!with_tracker_) {
    const auto lit = lit_.at(origin_ns);
    if (then && lit) follow(tracker_px2_, square_px2(seen, *then));
    if (then && lit) follow(innovation_px2_, square_px2(seen, *lit));
  }
}

void HandLadder::judge_landmarks(Evidence& evidence) const {
  const auto noise_px = static_cast<float>(settings_.filter.noise_px);
  const float detection_px2 = 2 * noise_px * noise_px;
  const float off_px2 = std::max(innovation_px2_.value_or(2 * detection_px2) - detection_px2, kLeastLandmark * detection_px2);
  if (settings_.filter.method == "ideal") {
    evidence.landmark_px2 = 0;
    evidence.lag_px2 = 0;
  } else if (with_tracker_) {
    evidence.landmark_px2 = off_px2;
  } else {  // off by noise and by lag, most of it common to all landmarks: fewer numbers follow no less of it, and P has no part in it
    evidence.landmark_px2 = kLeastLandmark * detection_px2;
    evidence.lag_px2 = off_px2;
    if (tracker_px2_) evidence.left_px2[0] = evidence.left_px2[1] = std::max(*tracker_px2_ - detection_px2, 0.0f);
  }
}

std::optional<HandLadder::Newest> HandLadder::newest(const HandTrack& track) const {
  const auto pose = track.pose_at(track.newest_ns());
  const auto tracker = pose ? project_landmarks(calibration_, *pose) : std::nullopt;
  return tracker ? std::optional(Newest{*pose, *tracker}) : std::nullopt;
}

HandLadder::Step HandLadder::take(const HandTrack& track, std::int64_t target_ns, std::optional<std::int64_t> camera_ns,
                                  HandTrack::Tracked& tracked) {
  if (!automatic_ && fixed_ >= Rung::landmarks) return {fixed_, Rung::landmarks, fixed_ == Rung::registered ? 1.0f : 0.0f};
  const auto newest_sample = newest(track);
  if (!newest_sample) return {Rung::landmarks, Rung::landmarks, 0};
  const Rung rung = automatic_ ? choose(track, target_ns, camera_ns, tracked, *newest_sample) : fixed_;
  if (!automatic_ && tracked.has_landmarks) models_[static_cast<std::size_t>(rung)] = fit_rung(rung, tracked.tracker, tracked.corrected);
  blend_.turn_to(rung, target_ns, automatic_ ? settings_.filter.blend_ms : 0);
  apply(*newest_sample, tracked);
  const Rung least = tracked.has_landmarks ? Rung::shift : Rung::hold;  // else what is blended in would not be drawn
  return {rung, blend_.is_pure(rung) ? std::clamp(rung, least, Rung::landmarks) : Rung::landmarks, blend_.share(Rung::registered)};
}

Rung HandLadder::choose(const HandTrack& track, std::int64_t target_ns, std::optional<std::int64_t> camera_ns,
                        const HandTrack::Tracked& tracked, const Newest& newest) {
  hindsight_.look_back(track);
  if (hindsight_.wants(target_ns)) {
    const auto at_camera = camera_ns ? track.pose_at(*camera_ns) : std::nullopt;
    const auto seen = at_camera ? project_landmarks(calibration_, *at_camera) : std::nullopt;
    hindsight_.remember({target_ns, camera_ns.value_or(track.newest_ns()), track.newest_ns(), newest.tracker,
                         seen.value_or(tracked.tracker), tracked.tracker});
  }
  const auto& [hold_px, predict_px, register_px] = hindsight_.motion();
  Evidence evidence{std::max(hold_px * hold_px, mean_square(newest.tracker, tracked.tracker)), predict_px * predict_px,
                    register_px * register_px};
  evidence.has_landmarks = tracked.has_landmarks;
  evidence.can_register = camera_ns.has_value();
  if (!tracked.has_landmarks) {
    models_ = {};
    offset_.reset();
    innovation_px2_.reset();
    tracker_px2_.reset();
    return gate_.choose(target_ns, evidence);
  }
  offset_.emplace();
  for (int i = 0; i < kLandmarks; ++i) (*offset_)[i] = tracked.corrected[i] - tracked.tracker[i];
  if (!with_tracker_) lit_.remember(target_ns, tracked.corrected);
  evidence.left_px2.fill(0);
  evidence.left_px2[0] = evidence.left_px2[1] = mean_square(tracked.tracker, tracked.corrected);
  judge_landmarks(evidence);
  for (const Rung rung : kModelled) {
    auto& model = models_[static_cast<std::size_t>(rung)] = fit_rung(rung, tracked.tracker, tracked.corrected);
    evidence.left_px2[static_cast<std::size_t>(rung)] = residual_px2(model, tracked.tracker, tracked.corrected);
  }
  return gate_.choose(target_ns, evidence);
}

void HandLadder::apply(const Newest& newest, HandTrack::Tracked& tracked) const {
  // Where a lower rung is not set but chosen, landmarks that are known go on: the tracker's jumps are blended in with them.
  const bool goes_on = automatic_ && tracked.has_landmarks;
  if (blend_.is_pure(Rung::hold)) {
    if (!goes_on) tracked.pose = newest.pose, tracked.tracker = newest.tracker;
    tracked.corrected = newest.tracker;
    tracked.has_landmarks = goes_on;
    return;
  }
  if (blend_.is_pure(Rung::predict)) {
    tracked.corrected = tracked.tracker;
    tracked.has_landmarks = goes_on;
    return;
  }
  const float held = blend_.share(Rung::hold), predicted = blend_.share(Rung::predict);
  const float full = blend_.share(Rung::landmarks) + blend_.share(Rung::registered);
  if (full == 1) return;
  LandmarkPoints mixed{};
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::vec2 p = tracked.tracker[i];
    mixed[i] = held * newest.tracker[i] + predicted * p + full * tracked.corrected[i];
    for (const Rung rung : kModelled)
      if (blend_.share(rung) > 0) mixed[i] += blend_.share(rung) * models_[static_cast<std::size_t>(rung)].moved(i, p);
  }
  if (!tracked.has_landmarks && held == 0) return;
  tracked.corrected = mixed;
  tracked.has_landmarks = true;
}

}  // namespace handcast::renderer
