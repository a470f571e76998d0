// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "renderer/ladder/rung.hpp"

namespace handcast::renderer {

/// Moves the vertices of a mesh by the model of a rung, about ten times faster than
/// correct_vertices().
class RungMover {
 public:
  /// Computes the share of each finger in each vertex of `mesh`.
  explicit RungMover(const HandMesh& mesh);
  /// Moves `vertices`, one per vertex of the mesh, in place. `model`: in the same unit.
  void move(const RungModel& model, std::span<glm::vec2> vertices) const;

 private:
  /// Skin weight of a finger in a vertex, 0..1: all vertices for the thumb, then for the index
  /// finger, and so on.
  std::vector<float> share_;
};

}  // namespace handcast::renderer
