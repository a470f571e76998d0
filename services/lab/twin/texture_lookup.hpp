// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "services/lab/twin/texture_map.hpp"

namespace handcast::twin {

/// Finds the point of a mesh that has given texture coordinates: the inverse of HandMesh::uv.
class TextureLookup {
 public:
  /// Copies what it needs of the mesh. Where charts overlap, any of the points is found.
  explicit TextureLookup(const renderer::HandMesh& mesh);

  /// The point at `uv`, or the nearest one of the texture: a fill may leave a chart by some texels.
  SurfacePoint at(glm::vec2 uv) const;

 private:
  static constexpr int kCells = 96;  ///< per side of the texture
  static int cell_of(float share);
  static constexpr std::size_t index(int x, int y) {
    return static_cast<std::size_t>(y) * kCells + static_cast<std::size_t>(x);
  }
  void enter(std::uint16_t triangle);

  std::vector<std::array<glm::vec2, 3>> corners_;  ///< by triangle
  std::vector<std::vector<std::uint16_t>> cells_;  ///< triangles that touch each cell
};

}  // namespace handcast::twin
