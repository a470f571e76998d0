// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/articulation.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "services/lab/twin/finger_pose.hpp"

namespace handcast::twin {
namespace {

using renderer::kJoints;

constexpr int kThumbRoot = 2;
constexpr std::array<int, 5> kFirstPhalanx{3, 7, 12, 17, 22};  ///< XR joints at the MCPs

glm::dmat4 turn(double radians, const glm::dvec3& axis) {
  return glm::rotate(glm::dmat4(1), radians, axis);
}

/// Rotation of each joint of a left hand about its own axes: +x points to the thumb, +y out of the
/// back, -z to the tip. Flexion is a negative rotation about x.
std::array<glm::dmat4, kJoints> turns_of(const Bend& bend) {
  std::array<glm::dmat4, kJoints> turns;
  turns.fill(glm::dmat4(1));
  turns[kThumbRoot] = turn(bend.thumb_opposition, {0, 1, 0}) *
                      turn(-bend.thumb_flexion, {1, 0, 0}) * turn(bend.thumb_roll, {0, 0, 1});
  for (int f = 0; f < 5; ++f) {
    const int phalanges = f == 0 ? 2 : 3;
    for (int k = 0; k < phalanges; ++k)
      turns[kFirstPhalanx[f] + k] = turn(-bend.flexion[f][k], {1, 0, 0});
    turns[kFirstPhalanx[f]] = turn(-bend.splay[f], {0, 1, 0}) * turns[kFirstPhalanx[f]];
  }
  return turns;
}

/// The mirror image in x of a rigid transform: S m S with S = diag(-1, 1, 1, 1), which is rigid.
glm::dmat4 mirrored(glm::dmat4 m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if ((c == 0) != (r == 0)) m[c][r] = -m[c][r];
  return m;
}

}  // namespace

Articulation::Articulation(const renderer::HandShape& shape) {
  const renderer::JointFrames rest = renderer::rest_frames(shape);
  for (int j = 0; j < kJoints; ++j) {
    const int parent = renderer::kJointParent[j];
    parent_from_joint_[j] =
        parent < 0 ? glm::dmat4(1) : glm::inverse(glm::dmat4(rest[parent])) * glm::dmat4(rest[j]);
  }
}

renderer::JointFrames Articulation::frames(renderer::Side side, const glm::dmat4& space_from_wrist,
                                           const Bend& bend) const {
  const auto turns = turns_of(bend);
  std::array<glm::dmat4, kJoints> wrist_from_joint;
  wrist_from_joint[kWristJoint] = glm::dmat4(1);
  wrist_from_joint[0] = parent_from_joint_[0];
  for (int j = kThumbRoot; j < kJoints; ++j)
    wrist_from_joint[j] =
        wrist_from_joint[renderer::kJointParent[j]] * parent_from_joint_[j] * turns[j];

  renderer::JointFrames frames;
  for (int j = 0; j < kJoints; ++j) {
    const glm::dmat4 local =
        side == renderer::Side::left ? wrist_from_joint[j] : mirrored(wrist_from_joint[j]);
    frames[j] = glm::mat4(space_from_wrist * local);
  }
  return frames;
}

}  // namespace handcast::twin
