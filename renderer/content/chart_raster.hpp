// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Calls `take(x, y, parts)` for each texel of a texture whose centre lies in a triangle of a hand;
/// `parts`: the shares of its corners, double, with sum 1. Texels on a shared edge may be taken
/// twice, but are not missed.
template <class Take>
void for_each_texel(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners, int width,
                    int height, const Take& take) {
  const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  const glm::dvec2 size(width, height);
  std::array<glm::dvec2, 3> at;  // in texels, whole numbers at their centres
  for (std::size_t k = 0; k < 3; ++k) at[k] = glm::dvec2(hand.uv[corners[k]]) * size - 0.5;
  const double area = cross(at[1] - at[0], at[2] - at[0]);
  if (area == 0) return;
  const glm::dvec2 low = glm::min(at[0], glm::min(at[1], at[2])),
                   high = glm::max(at[0], glm::max(at[1], at[2]));
  const Rect box =
      Rect{static_cast<int>(std::ceil(low.x)), static_cast<int>(std::ceil(low.y)),
           static_cast<int>(std::floor(high.x)) + 1, static_cast<int>(std::floor(high.y)) + 1}
          .within(width, height);
  constexpr double kSlack = 1e-9;
  const double clearly_outside = -1e-6 * std::abs(area), sign = area < 0 ? -1 : 1;
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x) {
      const glm::dvec2 p(x, y);
      const std::array areas{cross(at[2] - at[1], p - at[1]), cross(at[0] - at[2], p - at[2]),
                             cross(at[1] - at[0], p - at[0])};
      // Saves the divisions, which take most of the time.
      if (std::min({sign * areas[0], sign * areas[1], sign * areas[2]}) < clearly_outside) continue;
      const std::array parts{areas[0] / area, areas[1] / area, areas[2] / area};
      if (std::min({parts[0], parts[1], parts[2]}) >= -kSlack) take(x, y, parts);
    }
}

}  // namespace handcast::renderer
