// SPDX-License-Identifier: Apache-2.0
#include "renderer/ladder/gate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

constexpr float kFloor_px = 0.8f;  ///< error of the skin between the landmarks, equal on all rungs
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
/// A last frame farther away than this is not blended with.
constexpr std::int64_t kLongGap_ns = 100'000'000;
constexpr float kNearlyAll = 0.98f;     ///< a share above this becomes 1
constexpr float kOutOfReach_px = 1e6f;  ///< expected error of a rung that is not possible

constexpr std::size_t index_of(Rung rung) { return static_cast<std::size_t>(rung); }
constexpr Rung rung_at(std::size_t index) { return static_cast<Rung>(index); }

float model_px2(Rung rung, const Evidence& evidence) {
  if (!evidence.has_landmarks) return 0;
  const float followed = static_cast<float>(degrees_of_freedom(rung)) / (2 * kLandmarks);
  const float noise_px2 = evidence.landmark_px2;
  return std::max(evidence.left_px2[index_of(rung)] - noise_px2 * (1 - 2 * followed),
                  noise_px2 * followed);
}

float motion_px2(Rung rung, const Evidence& evidence) {
  if (rung == Rung::hold) return evidence.hold_px2;
  if (rung == Rung::registered) return evidence.register_px2;
  return rung == Rung::predict ? evidence.predict_px2
                               : evidence.lag_px2.value_or(evidence.predict_px2);
}

bool can_climb_to(Rung rung, const Evidence& evidence) {
  if (rung == Rung::registered && !evidence.can_register) return false;
  return rung <= Rung::predict || evidence.has_landmarks;
}

}  // namespace

std::array<float, kRungs> expected_errors_px(const Evidence& evidence) {
  std::array<float, kRungs> errors;
  for (std::size_t r = 0; r < kRungs; ++r) {
    const Rung rung = rung_at(r);
    const float square =
        kFloor_px * kFloor_px + model_px2(rung, evidence) + motion_px2(rung, evidence);
    errors[r] = can_climb_to(rung, evidence) ? std::sqrt(square) : kOutOfReach_px;
  }
  return errors;
}

Rung Gate::choose(std::int64_t target_ns, const Evidence& evidence) {
  const auto errors = expected_errors_px(evidence);
  const float enough_px = *std::ranges::min_element(errors) *
                          (1 + 0.01f * static_cast<float>(settings_.margin_percent));
  for (std::size_t r = 0; r < kRungs; ++r) {
    if (errors[r] > enough_px) {
      enough_since_ns_[r] = kNever;
    } else if (!started_ || enough_since_ns_[r] == kNever) {
      enough_since_ns_[r] = target_ns;
    }
  }
  const auto enough = [&](std::size_t r) { return errors[r] <= enough_px; };
  const auto dwelt = [&](std::size_t r) {
    return enough(r) && target_ns - enough_since_ns_[r] >= ms_to_ns(settings_.dwell_ms);
  };
  std::size_t rung = index_of(rung_);
  if (!started_) rung = 0;
  started_ = true;
  const std::size_t present = rung;
  while (rung + 1 < kRungs && !enough(rung)) ++rung;  // a more expensive rung is taken at once
  if (!enough(rung)) rung = present;  // only cheaper rungs qualify, and not for long enough
  for (std::size_t r = 0; r < present; ++r)
    if (dwelt(r)) {
      rung = r;
      break;
    }
  while (rung > 0 && errors[rung] >= kOutOfReach_px) --rung;  // its input is gone
  return rung_ = rung_at(rung);
}

void RungBlend::turn_to(Rung rung, std::int64_t target_ns, double blend_ms) {
  const double step_ms = ns_to_ms(target_ns - last_ns_);
  const bool at_once = !started_ || blend_ms <= 0 || target_ns - last_ns_ > kLongGap_ns;
  const float left = at_once ? 0 : static_cast<float>(std::exp(-std::max(step_ms, 0.0) / blend_ms));
  for (float& share : shares_) share *= left;
  float& share = shares_[index_of(rung)];
  share += 1 - left;
  if (share > kNearlyAll || at_once) {
    shares_.fill(0);
    share = 1;
  }
  last_ns_ = target_ns;
  started_ = true;
}

}  // namespace handcast::renderer
