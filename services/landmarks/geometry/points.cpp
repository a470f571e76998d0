// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/geometry/points.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::landmarks {

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

Points shifted(Points points_px, glm::vec2 by_px) {
  for (auto& point : points_px) point += by_px;
  return points_px;
}

bool is_finite(const Points& points_px) {
  return std::ranges::all_of(points_px,
                             [](glm::vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

}  // namespace handcast::landmarks
