// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/warp_cells.hpp"

namespace handcast::renderer::cpu {

void WarpCells::set(const WarpGrid& grid, Rect from) {
  place_nodes(grid);
  list_cells(grid, from);
}

void WarpCells::place_nodes(const WarpGrid& grid) {
  const auto count = static_cast<std::size_t>(grid.columns) * grid.rows;
  corners.resize(count);
  const float pitch_x = static_cast<float>(grid.area.width() - 1) / (grid.columns - 1);
  const float pitch_y = static_cast<float>(grid.area.height() - 1) / (grid.rows - 1);
  const auto outwards = [](int index, int size) {
    return index == 0 ? -0.5f : index == size - 1 ? 0.5f : 0.f;
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto node = [&](int c, int r) {
        return grid.nodes[static_cast<std::size_t>(r) * grid.columns + c];
      };
      const float out_x = outwards(column, grid.columns), out_y = outwards(row, grid.rows);
      const glm::vec2 here = node(column, row);
      const glm::vec2 along_x =
          out_x == 0 ? glm::vec2{0} : here - node(out_x < 0 ? 1 : column - 1, row);
      const glm::vec2 along_y =
          out_y == 0 ? glm::vec2{0} : here - node(column, out_y < 0 ? 1 : row - 1);
      const glm::vec2 moved = here + along_x * (0.5f / pitch_x) + along_y * (0.5f / pitch_y);
      corners[static_cast<std::size_t>(row) * grid.columns + column] = {
          snapped(moved.x),
          snapped(moved.y),
          0,
          grid.area.x0 + column * pitch_x + out_x,
          grid.area.y0 + row * pitch_y + out_y,
          0};
    }
  }
}

void WarpCells::list_cells(const WarpGrid& grid, Rect from) {
  triangles.clear();
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const int corner = row * grid.columns + column;
      const Corner &first = corners[corner], &last = corners[corner + grid.columns + 1];
      if (last.u < from.x0 - 1 || first.u > from.x1 || last.v < from.y0 - 1 || first.v > from.y1)
        continue;
      const auto index = [&](int c, int r) {
        return static_cast<std::uint16_t>(corner + r * grid.columns + c);
      };
      triangles.push_back({index(0, 0), index(1, 0), index(1, 1)});
      triangles.push_back({index(0, 0), index(1, 1), index(0, 1)});
    }
  }
}

}  // namespace handcast::renderer::cpu
