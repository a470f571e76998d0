// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "renderer/ladder/rung.hpp"

namespace handcast::renderer {

/// Whose skin is whose: moves a mesh's vertices with a model, some ten times cheaper than
/// correct_vertices.
class RungMover {
 public:
  explicit RungMover(const HandMesh& mesh);
  void move(const RungModel& model, std::span<glm::vec2> vertices) const;

 private:
  std::vector<float> share_;  ///< five per vertex, finger by finger: how much of its skin hangs on
                              ///< that finger, 0..1
};

}  // namespace handcast::renderer
