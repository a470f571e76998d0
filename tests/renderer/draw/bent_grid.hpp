// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "renderer/draw/painter.hpp"

namespace handcast::renderer::test {

/// A grid of 21 x 21 nodes that bends the image by up to 4 px and shifts it by a fraction of a
/// pixel.
inline WarpGrid bent_grid(const Rect& area) {
  WarpGrid grid{21, 21, area, {}};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      grid.nodes.push_back(grid.source(column, row) +
                           glm::vec2(2.3f + 3 * std::sin(0.9f * row + column),
                                     -1.7f + 2 * std::cos(1.1f * row - column)));
  return grid;
}

}  // namespace handcast::renderer::test
