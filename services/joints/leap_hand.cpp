// SPDX-License-Identifier: Apache-2.0
#include "services/joints/leap_hand.hpp"

namespace handcast::joints {
namespace {

/// Bone that ends at the joint: the one before the bone that starts there, on the same finger.
int bone_that_ends_at(int joint) {
  const bool is_root = joint == 2 || (joint > 2 && (joint - 1) % 5 == 0);
  const bool is_tip = joint > 2 && joint % 5 == 0;
  return is_root || is_tip || joint <= kWrist ? kLeapBone[joint] : kLeapBone[joint] - 1;
}

float radius_m(const LeapHand& hand, int joint) {
  const double width_mm =
      0.5 * (hand.width_mm[kLeapBone[joint]] + hand.width_mm[bone_that_ends_at(joint)]);
  return static_cast<float>(0.5e-3 * width_mm);
}

}  // namespace

std::optional<glm::dquat> axes_of_bone(const glm::dvec3& to_tip, const glm::dvec3& out_of_palm) {
  const glm::dvec3 to_wrist = -to_tip, back = -out_of_palm;
  const glm::dvec3 x = glm::cross(back, to_wrist);
  const double area = glm::length(x);
  if (!(area > 1e-2 * glm::length(back) * glm::length(to_wrist))) return std::nullopt;
  const glm::dvec3 z = glm::normalize(to_wrist);
  const glm::dvec3 lateral = glm::normalize(x);
  return glm::quat_cast(glm::dmat3(lateral, glm::cross(z, lateral), z));
}

msg::HandPose rig_hand(const LeapHand& hand) {
  msg::HandPose pose;
  pose.side = hand.side;
  pose.confidence = hand.confidence;
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::dquat& axes = hand.axes[kLeapBone[j]];
    auto& joint = pose.joints[j];
    joint.orientation_xyzw = {float(axes.x), float(axes.y), float(axes.z), float(axes.w)};
    joint.radius_m = radius_m(hand, j);
    for (int c = 0; c < 3 && j != kPalm; ++c)
      joint.position_m[c] = static_cast<float>(hand.joint_mm[kLeapJoint[j]][c] * 1e-3);
  }
  for (int c = 0; c < 3; ++c)
    pose.joints[kPalm].position_m[c] = 0.5f * (pose.joints[kMiddleMetacarpal].position_m[c] +
                                               pose.joints[kMiddleMetacarpal + 1].position_m[c]);
  return pose;
}

}  // namespace handcast::joints
