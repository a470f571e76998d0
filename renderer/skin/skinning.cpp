// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "renderer/base/clones.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {
namespace {

/// The transform of a bone: column-major 4x4, so that four bones are blended in one loop over 16
/// floats.
struct alignas(64) Bone {
  float m[16];
};

using Bones = std::array<Bone, kJoints>;

inline Bone blend(const Bones& bones, const std::array<std::uint8_t, 4>& joints,
                  const std::array<float, 4>& weights) {
  const float *a = bones[joints[0]].m, *b = bones[joints[1]].m, *c = bones[joints[2]].m,
              *d = bones[joints[3]].m;
  Bone blended;
  for (int k = 0; k < 16; ++k)
    blended.m[k] = weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k] + weights[3] * d[k];
  return blended;
}

inline glm::vec3 turned(const float* m, const glm::vec3& v) {
  return {m[0] * v.x + m[4] * v.y + m[8] * v.z, m[1] * v.x + m[5] * v.y + m[9] * v.z,
          m[2] * v.x + m[6] * v.y + m[10] * v.z};
}

HANDCAST_CLONES
void skin_positions(const HandMesh& hand, const Bones& bones, glm::vec3* positions) {
  const std::size_t count = hand.vertex_count();
  for (std::size_t v = 0; v < count; ++v) {
    const Bone bone = blend(bones, hand.joints[v], hand.weights[v]);
    positions[v] =
        turned(bone.m, hand.positions[v]) + glm::vec3(bone.m[12], bone.m[13], bone.m[14]);
  }
}

HANDCAST_CLONES
void skin_both(const HandMesh& hand, const Bones& bones, glm::vec3* positions, glm::vec3* normals) {
  const std::size_t count = hand.vertex_count();
  for (std::size_t v = 0; v < count; ++v) {
    const Bone bone = blend(bones, hand.joints[v], hand.weights[v]);
    positions[v] =
        turned(bone.m, hand.positions[v]) + glm::vec3(bone.m[12], bone.m[13], bone.m[14]);
    const glm::vec3 n = turned(bone.m, hand.normals[v]);
    normals[v] = n * (1.0f / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z + 1e-20f));
  }
}

}  // namespace

void skin(const HandMesh& hand, const JointFrames& frames, std::span<glm::vec3> positions,
          std::span<glm::vec3> normals) {
  Bones bones;
  for (int j = 0; j < kJoints; ++j) {
    const glm::mat4 posed_from_rest = frames[j] * glm::inverse(hand.rest[j]);
    for (int k = 0; k < 16; ++k) bones[j].m[k] = posed_from_rest[k / 4][k % 4];
  }
  if (normals.empty())
    skin_positions(hand, bones, positions.data());
  else
    skin_both(hand, bones, positions.data(), normals.data());
}

}  // namespace handcast::renderer
