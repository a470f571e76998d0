// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/seen_hand.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::pose::stereo {
namespace {

constexpr double kSmallest_px = 6;
/// Bones have other forms than the model's, and the landmarks of a detector other places: a share
/// of the hand's extent, about 1.5 mm.
constexpr double kModelShare = 0.025;

}  // namespace

double extent_px(const std::array<glm::dvec2, msg::kLandmarks>& px) {
  glm::dvec2 mean(0);
  for (const auto& point : px) mean += point / static_cast<double>(msg::kLandmarks);
  double squares = 0;
  for (const auto& point : px) squares += glm::dot(point - mean, point - mean);
  return std::sqrt(squares / msg::kLandmarks);
}

std::optional<SeenHand> read(const msg::HandLandmarks& landmarks) {
  SeenHand hand;
  int count = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& point = landmarks.points[i];
    if (!std::isfinite(point.x_px) || !std::isfinite(point.y_px) ||
        !std::isfinite(point.sigma_px) || !std::isfinite(point.confidence))
      return std::nullopt;
    hand.px[i] = {point.x_px, point.y_px};
    count += point.confidence > 0 ? 1 : 0;
  }
  const double extent = extent_px(hand.px);
  if (count < kFewestSeen || !(extent > kSmallest_px) || !(extent < 1e5)) return std::nullopt;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& point = landmarks.points[i];
    if (!(point.confidence > 0)) continue;
    const double sigma_px = std::clamp<double>(point.sigma_px, 0, extent);
    hand.sigma_px[i] =
        std::hypot(sigma_px, kModelShare * extent) / std::clamp<double>(point.confidence, 0.2, 1);
  }
  return hand;
}

}  // namespace handcast::pose::stereo
