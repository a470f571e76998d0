// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/models/mediapipe_regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace handcast::landmarks {
namespace {

constexpr std::array kPalmAndMiddleJoints{0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
constexpr float kLandmarkScale = 2.0f, kLandmarkShift = -0.1f;
constexpr float kPalmScale = 2.6f, kPalmShift = -0.5f;

/// The region's angle at which `from` to `to` points up.
float angle_of(glm::vec2 from, glm::vec2 to) { return std::atan2(to.x - from.x, from.y - to.y); }

/// Shifts the box along its own vertical by a share of its height and makes it a square, `scale`
/// times its longer side.
Region square_of(glm::vec2 centre_px, glm::vec2 extent_px, float angle_rad, float scale,
                 float shift) {
  const glm::vec2 moved = centre_px + turned({0, shift * extent_px.y}, angle_rad);
  return {moved, scale * std::max(extent_px.x, extent_px.y), angle_rad};
}

}  // namespace

Region mediapipe_region_of_landmarks(const Points& points_px) {
  const glm::vec2 knuckles = 0.25f * (points_px[5] + points_px[13]) + 0.5f * points_px[9];
  const float angle_rad = angle_of(points_px[0], knuckles);
  glm::vec2 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const int i : kPalmAndMiddleJoints) {
    const glm::vec2 upright = turned(points_px[i], -angle_rad);
    low = glm::min(low, upright);
    high = glm::max(high, upright);
  }
  return square_of(turned(0.5f * (low + high), angle_rad), high - low, angle_rad, kLandmarkScale,
                   kLandmarkShift);
}

Region mediapipe_region_of_palm(glm::vec2 centre_px, glm::vec2 extent_px, glm::vec2 wrist_px,
                                glm::vec2 middle_knuckle_px) {
  return square_of(centre_px, extent_px, angle_of(wrist_px, middle_knuckle_px), kPalmScale,
                   kPalmShift);
}

}  // namespace handcast::landmarks
