// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include "renderer/base/clones.hpp"
#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer::cpu {
namespace {

constexpr std::int32_t kNowhere = -1;

/// Sets `places` to the index in the source of each pixel of a block, or kNowhere. Returns true if
/// one has a source.
HANDCAST_CLONES bool find_sources(const PixelBlock& block, std::int32_t stride, Rect from,
                                  std::int32_t* __restrict places) {
  std::int32_t last = kNowhere;
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    // NOLINTBEGIN(bugprone-incorrect-roundings): lround is no vector instruction
    const auto x = static_cast<std::int32_t>(block.u[i] + 0.5f),
               y = static_cast<std::int32_t>(block.v[i] + 0.5f);
    // NOLINTEND(bugprone-incorrect-roundings)
    const bool inside = (block.depth[i] < std::numeric_limits<float>::infinity()) & (x >= from.x0) &
                        (x < from.x1) & (y >= from.y0) & (y < from.y1);
    places[i] = inside ? y * stride + x : kNowhere;
    last = std::max(last, places[i]);
  }
  return last != kNowhere;
}

/// Copies the pixels of one block whose sources are lit.
void fetch(const std::array<std::int32_t, kLanes>& places, int column, int row, Rect region,
           const FrameBuffer& in, FrameBuffer& out) {
  for (int i = 0; i < kLanes; ++i) {
    const int x = column * kBlockSide + i % kBlockSide, y = row * kBlockSide + i / kBlockSide;
    const std::int32_t place = places[i];
    if (place == kNowhere || x < region.x0 || x >= region.x1 || y < region.y0 || y >= region.y1)
      continue;
    const SurfaceId surface = in.surface.row(0)[place];
    if (surface == 0) continue;
    out.surface.row(y)[x] = surface;
    out.colour.row(y)[x] = in.colour.row(0)[place];
    out.uv.row(y)[x] = in.uv.row(0)[place];
    out.light.row(y)[x] = in.light.row(0)[place];
    out.lit[y] = out.lit[y].joined({x, x + 1});
  }
}

}  // namespace

void Warper::place_nodes(const WarpGrid& grid) {
  const auto count = static_cast<std::size_t>(grid.columns) * grid.rows;
  corners_.resize(count);
  ids_.assign(count, 1);
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
      corners_[static_cast<std::size_t>(row) * grid.columns + column] = {
          snapped(moved.x),
          snapped(moved.y),
          0,
          grid.area.x0 + column * pitch_x + out_x,
          grid.area.y0 + row * pitch_y + out_y,
          0};
    }
  }
}

void Warper::list_cells(const WarpGrid& grid, Rect from) {
  triangles_.clear();
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const int corner = row * grid.columns + column;
      const Corner &first = corners_[corner], &last = corners_[corner + grid.columns + 1];
      if (last.u < from.x0 - 1 || first.u > from.x1 || last.v < from.y0 - 1 || first.v > from.y1)
        continue;
      const auto index = [&](int c, int r) {
        return static_cast<std::uint16_t>(corner + r * grid.columns + c);
      };
      triangles_.push_back({index(0, 0), index(1, 0), index(1, 1)});
      triangles_.push_back({index(0, 0), index(1, 1), index(0, 1)});
    }
  }
  facing_of(corners_, triangles_, areas_);
}

void Warper::warp(const WarpGrid& grid, Rect from, Rect region, const FrameBuffer& in,
                  RasterTarget& target, FrameBuffer& out) {
  place_nodes(grid);
  list_cells(grid, from);
  target.clear();
  rasterise({corners_, triangles_, areas_, ids_, Facing::both}, region, target);
  for (int y = region.y0; y < region.y1; ++y) out.darken(y, region.x0, region.x1, {});
  std::array<std::int32_t, kLanes> places;
  for (int row = region.y0 / kBlockSide; row * kBlockSide < region.y1; ++row) {
    for (int column = target.drawn(row).x0; column < target.drawn(row).x1; ++column) {
      if (find_sources(target.row(row)[column], in.colour.stride(), from, places.data()))
        fetch(places, column, row, region, in, out);
    }
  }
}

}  // namespace handcast::renderer::cpu
