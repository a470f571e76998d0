// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "renderer/correct/deform.hpp"

namespace handcast::renderer {
namespace {

glm::vec2 pitch_px(const WarpGrid& grid) {
  return {static_cast<float>(grid.area.width() - 1) / static_cast<float>(grid.columns - 1),
          static_cast<float>(grid.area.height() - 1) / static_cast<float>(grid.rows - 1)};
}

}  // namespace

glm::vec2 WarpGrid::source(int column, int row) const {
  const glm::vec2 pitch = pitch_px(*this);
  return {static_cast<float>(area.x0) + pitch.x * static_cast<float>(column),
          static_cast<float>(area.y0) + pitch.y * static_cast<float>(row)};
}

glm::vec2 WarpGrid::operator()(glm::vec2 v) const {
  const glm::vec2 cell = (v - glm::vec2(area.x0, area.y0)) / pitch_px(*this);
  const int column = std::clamp(static_cast<int>(std::floor(cell.x)), 0, columns - 2);
  const int row = std::clamp(static_cast<int>(std::floor(cell.y)), 0, rows - 2);
  const float x = cell.x - static_cast<float>(column), y = cell.y - static_cast<float>(row);
  const glm::vec2* top = &nodes[static_cast<std::size_t>(row) * columns + column];
  const glm::vec2* bottom = top + columns;
  if (x >= y) return top[0] + x * (top[1] - top[0]) + y * (bottom[1] - top[1]);
  return top[0] + y * (bottom[0] - top[0]) + x * (bottom[1] - bottom[0]);
}

void make_warp_grid(const config::Correct& settings, Rect area, const MovingLeastSquares& field,
                    WarpGrid& grid) {
  grid.columns = settings.grid_columns;
  grid.rows = settings.grid_rows;
  grid.area = area;
  grid.nodes.clear();
  grid.nodes.reserve(static_cast<std::size_t>(grid.columns) * grid.rows);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      grid.nodes.push_back(grid.source(column, row));
  field.apply(grid.nodes);
}

}  // namespace handcast::renderer
