// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "ipc/msg/hand_poses.hpp"
#include "services/joints/leap_layout.hpp"

namespace handcast::joints {

/// One hand as a Leap Motion reports it, live or in a recording. Positions in mm: x to the right, y
/// up from the device, z to the user.
struct LeapHand {
  msg::Side side = msg::Side::left;
  float confidence = 1;                            ///< 0..1
  std::array<glm::dvec3, kLeapJoints> joint_mm{};  ///< numbered as in leap_layout.hpp
  std::array<glm::dquat, kLeapBones> axes{};       ///< from axes_of_bone()
  std::array<double, kLeapBones> width_mm{};       ///< of the flesh around each bone; 0: unknown
};

/// The rotation tracker from bone, in the axes of OpenXR, from two directions of the bone: to its
/// tip, and out of the palm. Of any length; they need not be orthogonal. The same for both hands.
/// Empty if they are no axes.
std::optional<glm::dquat> axes_of_bone(const glm::dvec3& to_tip, const glm::dvec3& out_of_palm);

/// The hand with the 26 joints of the rig, metres. The palm is half-way along the metacarpal of the
/// middle finger; a joint has half the mean width of the bones that meet there as its radius.
msg::HandPose rig_hand(const LeapHand& hand);

}  // namespace handcast::joints
