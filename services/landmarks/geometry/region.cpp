// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/geometry/region.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::landmarks {

glm::vec2 turned(glm::vec2 v, float angle_rad) {
  const float c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

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

}  // namespace handcast::landmarks
