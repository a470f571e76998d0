// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::joints {

// The joint and bone numbers of Leap Motion, and their relation to the 26 joints of
// XR_EXT_hand_tracking. 42 joints: 0 elbow, 1 wrist, 2+8f+2k and 3+8f+2k the ends of bone k (0
// metacarpal ... 3 distal) of finger f (0 thumb ... 4 little). 22 bones: 0 palm, 1 arm, 2+4f+k
// bone k of finger f. The thumb's metacarpal has length 0: its bones 1-3 are the metacarpal,
// proximal and distal bones of XR.

inline constexpr int kLeapJoints = 42;  ///< joints of a hand
inline constexpr int kLeapBones = 22;   ///< bones of a hand
inline constexpr int kPalm = 0;         ///< XR joint
inline constexpr int kWrist = 1;        ///< XR joint
/// The XR joint at the root of the middle finger. The palm joint is half-way along this bone.
inline constexpr int kMiddleMetacarpal = 11;

/// XR joint -> Leap joint; -1 for the palm, which Leap does not report.
inline constexpr std::array<int, msg::kJoints> kLeapJoint{-1, 1,  3,  5,  7,  9,  10, 11, 13,
                                                          15, 17, 18, 19, 21, 23, 25, 26, 27,
                                                          29, 31, 33, 34, 35, 37, 39, 41};
/// XR joint -> Leap bone with the joint's axes: the bone that starts there, or the distal bone for
/// a tip.
inline constexpr std::array<int, msg::kJoints> kLeapBone{
    0, 0, 3, 4, 5, 5, 6, 7, 8, 9, 9, 10, 11, 12, 13, 13, 14, 15, 16, 17, 17, 18, 19, 20, 21, 21};

/// One hand as a Leap Motion reports it, live or in a recording. Positions in mm: x to the right, y
/// up from the device, z to the user.
struct LeapHand {
  msg::Side side = msg::Side::left;
  float confidence = 1;                            ///< 0..1
  std::array<glm::dvec3, kLeapJoints> joint_mm{};  ///< numbered as above
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
