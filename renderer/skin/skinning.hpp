// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// Linear blend skinning: positions[v] = sum_j w_j frames[j] rest[j]^-1 hand.positions[v], in the
/// space of `frames`. `normals` (unit length) is not written if it is empty. Both must have room
/// for vertex_count() elements.
void skin(const HandMesh& hand, const JointFrames& frames, std::span<glm::vec3> positions,
          std::span<glm::vec3> normals = {});

}  // namespace handcast::renderer
