// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handcast::landmarks {

glm::vec2 turned(glm::vec2 v, float angle_rad) {
  const float c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

namespace {

constexpr std::array kPalmAndMiddleJoints{0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
constexpr float kLandmarkScale = 2.0f, kLandmarkShift = -0.1f;
constexpr float kPalmScale = 2.6f, kPalmShift = -0.5f;

/// The turn that makes `from` to `to` point up.
float angle_of(glm::vec2 from, glm::vec2 to) { return std::atan2(to.x - from.x, from.y - to.y); }

/// Shifted along its own vertical by a share of its height, then made a square of its longer side
/// times `scale`.
Region square_of(glm::vec2 centre_px, glm::vec2 extent_px, float angle_rad, float scale,
                 float shift) {
  const glm::vec2 moved = centre_px + turned({0, shift * extent_px.y}, angle_rad);
  return {moved, scale * std::max(extent_px.x, extent_px.y), angle_rad};
}

}  // namespace

glm::vec2 Region::to_image(glm::vec2 place) const {
  return centre_px + turned(place * size_px, angle_rad);
}
glm::vec2 Region::to_place(glm::vec2 image_px) const {
  return turned(image_px - centre_px, -angle_rad) / size_px;
}

Region region_of_image(int width_px, int height_px) {
  const glm::vec2 size(width_px, height_px);
  return {(size - 1.0f) * 0.5f, std::max(size.x, size.y), 0};
}

Region region_of_landmarks(const Points& points_px) {
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

Region region_of_palm(glm::vec2 centre_px, glm::vec2 extent_px, glm::vec2 wrist_px,
                      glm::vec2 middle_knuckle_px) {
  return square_of(centre_px, extent_px, angle_of(wrist_px, middle_knuckle_px), kPalmScale,
                   kPalmShift);
}

glm::vec2 centre_of(const Points& points_px) {
  glm::vec2 sum(0);
  for (const auto& point : points_px) sum += point;
  return sum / static_cast<float>(points_px.size());
}

float palm_length_px(const Points& points_px) { return glm::distance(points_px[0], points_px[9]); }

float distance_px(const Points& a, const Points& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::distance(a[i], b[i]);
  return sum / static_cast<float>(a.size());
}

bool is_finite(const Points& points_px) {
  return std::ranges::all_of(points_px,
                             [](glm::vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

}  // namespace handcast::landmarks
