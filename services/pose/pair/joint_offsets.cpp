// SPDX-License-Identifier: Apache-2.0
#include "services/pose/pair/joint_offsets.hpp"

#include <algorithm>

namespace handcast::pose {
namespace {

glm::vec3 position(const msg::Joint& joint) {
  return {joint.position_m[0], joint.position_m[1], joint.position_m[2]};
}

glm::quat orientation(const msg::Joint& joint) {
  const auto& [x, y, z, w] = joint.orientation_xyzw;
  return {w, x, y, z};
}

/// Of the two quaternions of a rotation, the one nearer to no rotation.
glm::quat shorter(const glm::quat& q) { return q.w < 0 ? -q : q; }

glm::quat mixed(const glm::quat& a, const glm::quat& b, float share) {
  return shorter(glm::normalize(a * (1 - share) + b * share));
}

const glm::quat kNone{1, 0, 0, 0};

}  // namespace

JointOffsets JointOffsets::between(const msg::HandPose& from, const msg::HandPose& to) {
  JointOffsets offsets;
  for (int j = 0; j < msg::kJoints; ++j) {
    offsets.moved_m_[j] = position(to.joints[j]) - position(from.joints[j]);
    offsets.turned_[j] =
        shorter(orientation(to.joints[j]) * glm::conjugate(orientation(from.joints[j])));
  }
  return offsets;
}

msg::HandPose JointOffsets::applied(const msg::HandPose& pose, float share) const {
  msg::HandPose moved = pose;
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::vec3 at = position(pose.joints[j]) + share * moved_m_[j];
    const glm::quat turned =
        glm::normalize(mixed(kNone, turned_[j], share) * orientation(pose.joints[j]));
    moved.joints[j].position_m = {at.x, at.y, at.z};
    moved.joints[j].orientation_xyzw = {turned.x, turned.y, turned.z, turned.w};
  }
  return moved;
}

void JointOffsets::approach(const JointOffsets& other, float share) {
  for (int j = 0; j < msg::kJoints; ++j) {
    moved_m_[j] = glm::mix(moved_m_[j], other.moved_m_[j], share);
    turned_[j] = mixed(turned_[j], other.turned_[j], share);
  }
}

JointOffsets JointOffsets::reversed() const {
  JointOffsets offsets;
  for (int j = 0; j < msg::kJoints; ++j) {
    offsets.moved_m_[j] = -moved_m_[j];
    offsets.turned_[j] = glm::conjugate(turned_[j]);
  }
  return offsets;
}

float JointOffsets::farthest_m(const JointOffsets& other) const {
  float farthest_m = 0;
  for (int j = 0; j < msg::kJoints; ++j)
    farthest_m = std::max(farthest_m, glm::distance(moved_m_[j], other.moved_m_[j]));
  return farthest_m;
}

float JointOffsets::mean_m(const JointOffsets& other) const {
  float sum_m = 0;
  for (int j = 0; j < msg::kJoints; ++j) sum_m += glm::distance(moved_m_[j], other.moved_m_[j]);
  return sum_m / msg::kJoints;
}

}  // namespace handcast::pose
