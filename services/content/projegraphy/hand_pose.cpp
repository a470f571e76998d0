// SPDX-License-Identifier: Apache-2.0
#include <glm/gtc/matrix_transform.hpp>

#include "services/content/projegraphy/animals.hpp"

namespace handcast::projegraphy {
namespace {

using renderer::kJoints;

constexpr int kWrist = 1, kThumbRoot = 2;
constexpr std::array<std::size_t, 5> kFirstPhalanx{3, 7, 12, 17, 22};  ///< joints at the MCPs

glm::mat4 turned(float degrees, const glm::vec3& axis) {
  return glm::rotate(glm::mat4(1), glm::radians(degrees), axis);
}

/// The rotation of each joint about its own axes; `mirror` is -1 for a right hand.
std::array<glm::mat4, kJoints> turns_of(const HeldHand& held, float mirror) {
  std::array<glm::mat4, kJoints> turns;
  turns.fill(glm::mat4(1));
  const glm::vec3 x(1, 0, 0), y(0, 1, 0);
  turns[kThumbRoot] = turned(mirror * held.thumb_opposition, y) * turned(-held.thumb_flexion, x);
  for (std::size_t f = 0; f < 5; ++f) {
    for (std::size_t k = 0; k < (f == 0 ? 2 : 3); ++k)
      turns[kFirstPhalanx[f] + k] = turned(-held.flexion[f][k], x);
    turns[kFirstPhalanx[f]] = turned(-mirror * held.splay[f], y) * turns[kFirstPhalanx[f]];
  }
  return turns;
}

}  // namespace

renderer::JointFrames joints_of(const renderer::HandMesh& mesh, const HeldHand& held) {
  const float mirror = mesh.side == renderer::Side::left ? 1.f : -1.f;
  const glm::mat4 upright{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}};
  const glm::mat4 place = glm::translate(glm::mat4(1), glm::vec3(held.wrist_m, 0));
  const auto turns = turns_of(held, mirror);
  renderer::JointFrames joints;
  joints[kWrist] = place * turned(held.spin, {0, 0, 1}) * upright * turned(held.nod, {1, 0, 0}) *
                   turned(mirror * held.turn, {0, 0, 1});
  for (std::size_t j = 0; j < kJoints; ++j) {
    if (j == kWrist) continue;
    const auto parent = static_cast<std::size_t>(renderer::kJointParent[j]);
    joints[j] = joints[parent] * glm::inverse(mesh.rest[parent]) * mesh.rest[j] * turns[j];
  }
  return joints;
}

}  // namespace handcast::projegraphy
