// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "services/lab/twin/texture_map.hpp"
#include "services/lab/twin/true_view.hpp"

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

/// Where the texture of the drawn hands belongs on the true ones at one time. One thread.
class PlacedTexture {
 public:
  /// `twin` must outlive it.
  explicit PlacedTexture(const Twin& twin);

  /// Places the texture of one hand on its ground-truth mesh, as it is seen and at rest.
  void place(const SeenHand& hand);

  /// A point of the texture, m.
  struct Point {
    glm::vec3 seen_m;  ///< camera space, at the time of place()
    glm::vec3 rest_m;  ///< model space
  };
  /// The point of these texture coordinates on a hand that was placed.
  Point at(Side side, glm::vec2 uv) const;

 private:
  struct Placed {
    std::vector<glm::vec3> seen_m, rest_m;  ///< by vertex of the drawn mesh
  };
  const Twin& twin_;
  std::array<TextureLookup, 2> lookup_;
  std::array<Placed, 2> placed_;
};

}  // namespace handcast::twin
