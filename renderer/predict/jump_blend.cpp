// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/jump_blend.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

/// A last frame farther away than this is not blended with.
constexpr std::int64_t kGapWithoutBlend_ns = 100'000'000;

}  // namespace

glm::vec2 JumpBlend::bounded(const glm::vec2& jump_px) const {
  const float length = glm::length(jump_px);
  return length > blend_px_ ? jump_px * (blend_px_ / length) : jump_px;
}

std::optional<std::int64_t> JumpBlend::last_ns(std::int64_t target_ns) const {
  return last_ns_ && std::abs(target_ns - *last_ns_) <= kGapWithoutBlend_ns ? last_ns_
                                                                            : std::nullopt;
}

LandmarkPoints JumpBlend::smooth(std::int64_t target_ns, const LandmarkPoints& wanted,
                                 const LandmarkPoints& last_known) {
  LandmarkPoints jumps{};
  if (const auto last = last_ns(target_ns)) {
    const auto step_ms = static_cast<float>(ns_to_ms(target_ns - *last));
    for (int i = 0; i < kLandmarks; ++i) {
      jumps[i] = last_[i] - last_known[i];
      if (step_ms > 0) velocity_px_ms_[i] = (wanted[i] - last_known[i]) / step_ms;
    }
  }
  return blended(target_ns, wanted, jumps);
}

LandmarkPoints JumpBlend::follow(std::int64_t target_ns, const LandmarkPoints& wanted, bool news) {
  LandmarkPoints jumps{};
  if (const auto last = last_ns(target_ns)) {
    const auto step_ms = static_cast<float>(ns_to_ms(target_ns - *last));
    for (int i = 0; i < kLandmarks; ++i) {
      if (news) jumps[i] = last_[i] + velocity_px_ms_[i] * step_ms - wanted[i];
      if (!news && step_ms > 0) velocity_px_ms_[i] = (wanted[i] - last_[i]) / step_ms;
    }
  }
  return blended(target_ns, wanted, jumps);
}

LandmarkPoints JumpBlend::blended(std::int64_t target_ns, const LandmarkPoints& wanted,
                                  const LandmarkPoints& jumps_px) {
  LandmarkPoints points = wanted;
  const auto last = last_ns(target_ns);
  if (!last) velocity_px_ms_ = {};
  if (last && blend_ms_ > 0) {
    const auto step_ms = static_cast<float>(ns_to_ms(std::max<std::int64_t>(target_ns - *last, 0)));
    const float left = std::exp(-step_ms / blend_ms_);
    for (int i = 0; i < kLandmarks; ++i) {
      held_back_[i] = bounded(left * held_back_[i] + jumps_px[i]);
      points[i] += held_back_[i];
    }
  } else {
    held_back_ = {};
  }
  last_ = wanted;
  last_ns_ = target_ns;
  return points;
}

}  // namespace handcast::renderer
