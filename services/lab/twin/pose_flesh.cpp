// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

#include "renderer/base/clones.hpp"
#include "renderer/skin/skinning.hpp"
#include "services/lab/twin/true_hands.hpp"

namespace handcast::twin {
namespace {

/// A rigid motion as a unit dual quaternion: w, x, y, z of the real part and of the dual one.
using DualQuaternion = std::array<float, 8>;

glm::quat real_of(const DualQuaternion& q) { return {q[0], q[1], q[2], q[3]}; }
glm::quat dual_of(const DualQuaternion& q) { return {q[4], q[5], q[6], q[7]}; }

DualQuaternion motion_of(const glm::mat4& moved, const glm::mat4& rest) {
  const glm::quat turn = glm::normalize(glm::quat_cast(glm::mat3(moved)) *
                                        glm::conjugate(glm::quat_cast(glm::mat3(rest))));
  const glm::vec3 shift = glm::vec3(moved[3]) - turn * glm::vec3(rest[3]);
  const glm::quat dual = glm::quat(0, shift.x, shift.y, shift.z) * turn * 0.5f;
  return {turn.w, turn.x, turn.y, turn.z, dual.w, dual.x, dual.y, dual.z};
}

/// Dual-quaternion blending (Kavan et al. 2007, "Skinning with Dual Quaternions", section 4).
HANDCAST_CLONES
void pose_by_dual_quaternions(const renderer::HandMesh& mesh, const JointFrames& joints,
                              std::span<glm::vec3> positions, std::span<glm::vec3> normals) {
  std::array<DualQuaternion, msg::kJoints> motion;
  for (int j = 0; j < msg::kJoints; ++j) motion[j] = motion_of(joints[j], mesh.rest[j]);
  // -1: the quaternions of two joints lie on opposite hemispheres.
  std::array<std::array<float, msg::kJoints>, msg::kJoints> sign;
  for (int i = 0; i < msg::kJoints; ++i)
    for (int j = 0; j < msg::kJoints; ++j)
      sign[i][j] = glm::dot(real_of(motion[i]), real_of(motion[j])) < 0 ? -1.0f : 1.0f;

  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto& weights = mesh.weights[v];
    const auto strongest =
        static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin());
    const auto& signs = sign[mesh.joints[v][strongest]];
    DualQuaternion sum{};
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const auto joint = mesh.joints[v][k];
      const float weight = signs[joint] * weights[k];
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * motion[joint][i];
    }
    const float scale = 1 / glm::length(real_of(sum));
    for (float& part : sum) part *= scale;
    const glm::quat real = real_of(sum);
    const glm::quat shift = dual_of(sum) * glm::conjugate(real) * 2.0f;
    positions[v] = real * mesh.positions[v] + glm::vec3(shift.x, shift.y, shift.z);
    if (!normals.empty()) normals[v] = real * mesh.normals[v];
  }
}

/// How far each joint is bent beyond its rest, 1: by 90 degrees.
std::array<float, msg::kJoints> bends(const TrueHand& hand, const JointFrames& joints) {
  const auto angle = [](const JointFrames& frames, int j) {
    const glm::vec3 outer(frames[j][2]), inner(frames[renderer::kJointParent[j]][2]);
    return std::acos(
        std::clamp(glm::dot(glm::normalize(outer), glm::normalize(inner)), -1.0f, 1.0f));
  };
  std::array<float, msg::kJoints> bend{};
  for (int j = 2; j < msg::kJoints; ++j)
    bend[j] = std::max(
        0.0f, (angle(joints, j) - angle(hand.mesh.rest, j)) * 2 / std::numbers::pi_v<float>);
  return bend;
}

void bulge(const TrueHand& hand, const JointFrames& joints, std::span<glm::vec3> positions,
           std::span<const glm::vec3> normals) {
  const auto bend = bends(hand, joints);
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] += normals[v] * (hand.bulge_m[v] * bend[hand.bulge_joint[v]]);
}

void follow_bones(const TrueHand& hand, const JointFrames& joints, std::span<glm::vec3> positions,
                  std::span<glm::vec3> normals) {
  if (hand.skinning == config::TwinSkinning::linear)
    renderer::skin(hand.mesh, joints, positions, normals);
  else
    pose_by_dual_quaternions(hand.mesh, joints, positions, normals);
}

}  // namespace

void pose(const TrueHand& hand, const JointFrames& joints, std::span<glm::vec3> positions,
          std::span<glm::vec3> normals) {
  if (hand.bulge_m.empty()) return follow_bones(hand, joints, positions, normals);
  std::vector<glm::vec3> own;
  if (normals.empty()) {
    own.resize(positions.size());
    normals = own;
  }
  follow_bones(hand, joints, positions, normals);
  bulge(hand, joints, positions, normals);
}

}  // namespace handcast::twin
