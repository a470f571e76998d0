// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Removes fold-overs: triangles that a correction has turned over. The corners of such a triangle
/// get their mean displacement, and its neighbours are examined again. This repairs the slivers of
/// the mesh, which a tenth of a pixel turns over. If it does not end soon, turned-over triangles
/// are joined into clusters that move with the mean of their displacements. Inside a cluster
/// nothing is turned over, and clusters only grow, so this ends. Vertices at the same position (UV
/// seams) move together. One thread.
class FoldoverRepair {
 public:
  /// For the triangles of `mesh`.
  explicit FoldoverRepair(const HandMesh& mesh);

  /// Repairs `after`, the vertices after a correction; `before`: the same before it, px. Only
  /// triangles that face the camera are examined: those whose area has the sign `facing_sign` (y
  /// down). An area of up to 0.01 px^2 does not count as turned over. Returns the number of
  /// triangles that remain turned over, which should be 0.
  int repair(std::span<const glm::vec2> before, std::span<glm::vec2> after, float facing_sign);
  /// The number of triangles that are turned over in `after`, counted in the same way.
  int count(std::span<const glm::vec2> before, std::span<const glm::vec2> after,
            float facing_sign) const;

 private:
  using Triangle = std::array<std::uint16_t, 3>;
  struct Cluster {
    std::uint16_t parent;  ///< a place nearer to the root; its own if it is the root
    glm::vec2 moved;       ///< in the root: sum of the displacements of the cluster
    float count;           ///< in the root: places of the cluster
  };

  bool turned_over(std::size_t triangle, std::span<const glm::vec2> before,
                   std::span<const glm::vec2> after, float facing_sign) const;
  void find_turned_over(std::span<const glm::vec2> before, std::span<const glm::vec2> after,
                        float facing_sign);
  void find_facing(std::span<const glm::vec2> before, float facing_sign);
  bool smooth(std::span<const glm::vec2> before, std::span<glm::vec2> after, float facing_sign);
  void start(std::span<const glm::vec2> before, std::span<const glm::vec2> after);
  std::uint16_t root_of(std::uint16_t place);
  bool join(const Triangle& triangle);
  void move_clusters(std::span<const glm::vec2> before, std::span<glm::vec2> after);

  std::vector<Triangle> triangles_;
  // A place is a position at rest that one or more vertices have.
  std::vector<std::uint16_t> place_of_;               ///< per vertex
  std::vector<std::vector<std::uint16_t>> at_place_;  ///< per place: its vertices
  std::vector<std::vector<std::uint32_t>> around_;    ///< per place: the triangles that touch it
  std::vector<Cluster> clusters_;                     ///< per place
  std::vector<std::uint32_t> waiting_;                ///< triangles to be examined
};

}  // namespace handcast::renderer
