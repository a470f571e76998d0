// SPDX-License-Identifier: Apache-2.0
#include "renderer/register/late_registration.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/base/noise.hpp"

namespace handcast::renderer {
namespace {

/// Greatest age of an anchor: usually, and for a camera with 30 images a second.
constexpr std::int64_t kKept_ns = 30'000'000, kLongestKept_ns = 60'000'000;
constexpr std::int64_t kFresh_ns = 20'000'000;  ///< longest time from an exposure to the photons
// Noise of registration: the displacement of a hand that moved as predicted.
constexpr float kHandNoise_px = 0.22f;   ///< of the mean of all landmarks
constexpr float kFingerNoise_px = 0.7f;  ///< of a part of the hand relative to that mean
/// The error of a prediction over less than this tells little about its growth.
constexpr float kTrusted_ms = 5;

/// The landmarks of the palm and of each finger.
constexpr std::array<std::array<int, 5>, 6> kParts{{{0, 5, 9, 13, 17},
                                                    {1, 2, 3, 4, 4},
                                                    {5, 6, 7, 8, 8},
                                                    {9, 10, 11, 12, 12},
                                                    {13, 14, 15, 16, 16},
                                                    {17, 18, 19, 20, 20}}};

/// Shrinks displacements by the noise: first the mean over the hand, which has less noise, then
/// each part relative to it.
void shrink(LandmarkPoints& moved) {
  glm::vec2 mean{0};
  for (const glm::vec2& point : moved) mean += point / static_cast<float>(kLandmarks);
  const glm::vec2 hand = mean * share_beyond_noise(glm::dot(mean, mean), kHandNoise_px);
  std::array<float, kLandmarks> share{};
  for (const auto& part : kParts) {
    float square = 0;
    for (const int i : part)
      square += glm::dot(moved[i] - mean, moved[i] - mean) / static_cast<float>(part.size());
    for (const int i : part) share[i] = share_beyond_noise(square, kFingerNoise_px);
  }
  for (int i = 0; i < kLandmarks; ++i) moved[i] = hand + share[i] * (moved[i] - mean);
}

/// The ratio of a prediction's error at the wanted time to that at the seen time, both after the
/// newest sample. The error grows faster than linearly; the part caused by acceleration grows with
/// the square of the time. The exponent 1.5 was found by measurement.
float growth_of_error(std::int64_t seen_after_ns, std::int64_t wanted_after_ns) {
  const auto power = [](float ms) { return ms > 0 ? ms * std::sqrt(ms) : 0; };
  const float seen = power(static_cast<float>(ns_to_ms(seen_after_ns))),
              wanted = power(static_cast<float>(ns_to_ms(wanted_after_ns)));
  const float trusted = power(kTrusted_ms);
  return seen * wanted / (seen * seen + trusted * trusted);
}

}  // namespace

LateRegistration::LateRegistration(const config::Registration& settings,
                                   const config::Filter& filter,
                                   const calib::Calibration& calibration)
    : settings_(settings),
      calibration_(calibration),
      registration_(static_cast<float>(settings.limit_px)),
      outlines_(on() ? kOutlines : 0),
      blend_{filter.blend_ms, filter.blend_px},
      blends_{JumpBlend(filter.blend_ms, filter.blend_px),
              JumpBlend(filter.blend_ms, filter.blend_px)} {}

void LateRegistration::adjust(const config::Registration& settings, const config::Filter& filter) {
  if (settings.limit_px != settings_.limit_px)
    registration_ = Registration(static_cast<float>(settings.limit_px));
  settings_ = settings;
  if (on()) outlines_.resize(kOutlines);
  if (const std::pair blend{filter.blend_ms, filter.blend_px};
      std::exchange(blend_, blend) != blend)
    blends_.fill(JumpBlend(filter.blend_ms, filter.blend_px));
}

const LateRegistration::Outline* LateRegistration::anchor_before(std::int64_t time_ns) const {
  const auto kept_ns = std::clamp(3 * interval_ns_ / 2, kKept_ns, kLongestKept_ns);
  const Outline* newest = nullptr;
  for (const Outline& outline : outlines_)
    if (outline.time_ns > 0 && outline.time_ns <= time_ns &&
        outline.time_ns > newest_ns_ - kept_ns && (!newest || outline.time_ns > newest->time_ns))
      newest = &outline;
  return newest;
}

std::optional<HandMotion> LateRegistration::motion_of(const Hand& hand, std::int64_t then_ns,
                                                      std::int64_t now_ns) const {
  const auto then = hand.track->landmarks_at(then_ns), now = hand.track->landmarks_at(now_ns);
  if (!then || !now) return std::nullopt;
  HandMotion motion;
  for (int i = 0; i < kLandmarks; ++i) {
    motion.then[i] = calibration_.camera.distort((*then)[i] + hand.offset_px[i]);
    motion.now[i] = calibration_.camera.distort((*now)[i] + hand.offset_px[i]);
  }
  return motion;
}

void LateRegistration::look(const Silhouette& newest, std::span<const Hand> hands) {
  if (!on() || newest.origin_ns <= newest_ns_) return;
  interval_ns_ = newest.origin_ns - newest_ns_;
  newest_ns_ = newest.origin_ns;
  for (std::size_t h = 0; h < hands.size(); ++h) find_hand(newest, hands, h);
  Outline& outline = outlines_[next_outline_++ % kOutlines];
  outline.time_ns = newest.origin_ns;
  find_contour(newest, outline.contour);
}

void LateRegistration::find_hand(const Silhouette& newest, std::span<const Hand> hands,
                                 std::size_t index) {
  const Hand& hand = hands[index];
  Registered& found = last_[static_cast<std::size_t>(hand.side)] = {};
  const Outline* anchor = hand.is_alone ? nullptr : anchor_before(hand.track->newest_ns());
  if (!anchor || anchor->time_ns < hand.track->comparable_ns()) return;

  std::array<HandMotion, msg::kMaxHands> motions;  // that of `hand` first
  std::size_t count = 0;
  for (std::size_t i = 0; i < hands.size() && count < motions.size(); ++i) {
    const Hand& each = hands[(index + i) % hands.size()];
    if (const auto motion = motion_of(each, anchor->time_ns, newest_ns_))
      motions[count++] = *motion;
    if (count == 0) return;
  }
  found = registration_.find(anchor->contour, newest, std::span(motions).first(count), 0);
  if (!found.found) return;
  Seen& seen = seen_[static_cast<std::size_t>(hand.side)];
  seen.time_ns = newest_ns_;
  seen.anchor_ns = anchor->time_ns;
  for (int i = 0; i < kLandmarks; ++i)
    seen.points[i] = glm::vec2(calibration_.camera.undistort(motions[0].now[i] + found.moved[i])) -
                     hand.offset_px[i];
}

/// The error of the tracker's prediction for the time of the newest image.
LandmarkPoints LateRegistration::missed(const Hand& hand, std::int64_t target_ns) const {
  const Seen& seen = seen_[static_cast<std::size_t>(hand.side)];
  if (seen.time_ns <= hand.track->newest_ns() || target_ns - seen.time_ns > kFresh_ns) return {};
  if (hand.is_alone || seen.anchor_ns < hand.track->comparable_ns()) return {};
  const auto predicted = hand.track->landmarks_at(seen.time_ns);
  if (!predicted) return {};
  LandmarkPoints moved;
  for (int i = 0; i < kLandmarks; ++i) {
    moved[i] = seen.points[i] - (*predicted)[i];
    if (glm::length(moved[i]) > static_cast<float>(settings_.limit_px)) return {};
  }
  shrink(moved);
  return moved;
}

RegisteredHand LateRegistration::correct(const Hand& hand, std::int64_t target_ns) {
  const auto side = static_cast<std::size_t>(hand.side);
  const std::int64_t heard_ns = hand.track->newest_ns(), seen_ns = seen_[side].time_ns;
  RegisteredHand registered;
  const LandmarkPoints moved = missed(hand, target_ns);
  const auto placed = [&](const LandmarkPoints& tracker, std::int64_t time_ns) {
    const float growth = growth_of_error(seen_ns - heard_ns, time_ns - heard_ns);
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i)
      points[i] = tracker[i] + hand.offset_px[i] + growth * moved[i];
    return points;
  };
  registered.landmarks = placed(hand.tracker, target_ns);
  for (int i = 0; i < kLandmarks; ++i) {
    registered.moved_then[i] = moved[i];
    registered.moved_now[i] = registered.landmarks[i] - hand.tracker[i] - hand.offset_px[i];
  }
  const auto last_ns = blends_[side].last_ns(target_ns);
  const auto tracker_last = last_ns ? hand.track->landmarks_at(*last_ns) : std::nullopt;
  registered.landmarks =
      blends_[side].smooth(target_ns, registered.landmarks,
                           tracker_last ? placed(*tracker_last, *last_ns) : registered.landmarks);
  return registered;
}

LandmarkPoints LateRegistration::follow(const Hand& hand, std::int64_t target_ns, bool has_news) {
  return blends_[static_cast<std::size_t>(hand.side)].follow(
      target_ns, sum(hand.tracker, hand.offset_px), has_news);
}

}  // namespace handcast::renderer
