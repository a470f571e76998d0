// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::twin {

/// A point on the surface of a mesh.
struct SurfacePoint {
  std::uint16_t triangle = 0;  ///< its index
  glm::vec3 share{0};          ///< barycentric coordinates in the triangle, with sum 1

  /// The point, by the positions of the mesh's vertices.
  glm::vec3 on(const renderer::HandMesh& mesh, std::span<const glm::vec3> positions) const {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return share.x * positions[a] + share.y * positions[b] + share.z * positions[c];
  }
};

/// Where each vertex of the drawn mesh is on another surface of the same hand, by vertex: the place
/// that the texture means, which is the nearest point of the ground-truth mesh. Both must be at
/// rest in the same pose (`rest` equal up to rounding).
std::vector<SurfacePoint> texture_map(const renderer::HandMesh& drawn,
                                      const renderer::HandMesh& truth);

/// The map of a mesh onto itself.
std::vector<SurfacePoint> own_texture_map(const renderer::HandMesh& mesh);

}  // namespace handcast::twin
