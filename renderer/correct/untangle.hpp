// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Turns back what a correction turned over. The corners of such a triangle get one common
/// displacement and its neighbours are looked at again; the mesh has slivers that a tenth of a
/// pixel turns over, and this mends them. Knots that it does not mend are joined into clusters that
/// move as one, with the mean of their displacements: inside a cluster nothing is turned over, and
/// clusters only grow, so this ends. Vertices that share a place (UV seams) stay together. One
/// thread.
class Untangler {
 public:
  explicit Untangler(const HandMesh& mesh);

  /// `facing_sign`: of the area of triangles that face the camera (y down); only those are looked
  /// at. Moves `after`; returns how many triangles stay turned over: none, or the promise above is
  /// broken. A hundredth of a pixel is no area.
  int untangle(std::span<const glm::vec2> before, std::span<glm::vec2> after, float facing_sign);

 private:
  using Triangle = std::array<std::uint16_t, 3>;
  struct Cluster {
    std::uint16_t parent;  ///< towards the root, which is its own parent
    std::uint16_t next;    ///< the places of a cluster form a ring
    glm::vec2 moved;       ///< a root's: sum over the cluster
    float count;           ///< a root's
  };

  bool turned_over(std::size_t triangle, std::span<const glm::vec2> before,
                   std::span<const glm::vec2> after, float facing_sign) const;
  void find_turned_over(std::span<const glm::vec2> before, std::span<const glm::vec2> after,
                        float facing_sign);
  void shift(std::uint16_t place, const glm::vec2& moved, std::span<const glm::vec2> before,
             std::span<glm::vec2> after);
  bool smooth(std::span<const glm::vec2> before, std::span<glm::vec2> after, float facing_sign);
  void start(std::span<const glm::vec2> before, std::span<const glm::vec2> after);
  std::uint16_t root_of(std::uint16_t place);
  std::uint16_t join(const Triangle& triangle);
  void move(std::uint16_t root, std::span<const glm::vec2> before, std::span<glm::vec2> after);

  std::vector<Triangle> triangles_;
  std::vector<std::uint16_t> place_of_;               ///< of each vertex
  std::vector<std::vector<std::uint16_t>> at_place_;  ///< the vertices that share it
  std::vector<std::vector<std::uint32_t>> around_;    ///< the triangles that touch it
  std::vector<Cluster> clusters_;                     ///< of each place
  std::vector<std::uint32_t> waiting_;                ///< triangles to look at again
};

}  // namespace handcast::renderer
