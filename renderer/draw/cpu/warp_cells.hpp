// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "renderer/correct/deform.hpp"
#include "renderer/draw/cpu/raster.hpp"

namespace handcast::renderer::cpu {

/// A warp grid as triangles: moved positions, with the positions at rest (px) as texture
/// coordinates. The outermost cells extend by half a pixel, to the edge of the corner pixels, so
/// that a grid at rest moves nothing and loses nothing.
struct WarpCells {
  std::vector<Corner> corners;             ///< one per node of the grid
  std::vector<TriangleIndices> triangles;  ///< of the cells near `from`, row by row, from the left

  /// Sets both for the part `from` of the drawing.
  void set(const WarpGrid& grid, Rect from);

 private:
  void place_nodes(const WarpGrid& grid);
  void list_cells(const WarpGrid& grid, Rect from);
};

}  // namespace handcast::renderer::cpu
