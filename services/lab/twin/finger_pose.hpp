// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "services/lab/hand_maker/hand_shape.hpp"

/// Changes of a posed hand that keep its bones: each is a rotation at a joint. Joints are those of
/// XR_EXT_hand_tracking, hand axes +x to the thumb of a left hand, +y out of the back, -z to the
/// tip. Fingers: 0 thumb ... 4 little.
namespace handcast::twin {

using renderer::JointFrames;
using renderer::kJoints;

inline constexpr int kWristJoint = 1;
inline constexpr int kFingers = 5;
inline constexpr std::array<int, kFingers> kMetacarpalJoint{2, 6, 11, 16, 21};
/// The joints of a finger that bend, from the palm on. The thumb's third is not used.
inline constexpr int kBends = 3;
/// Number of joints that bend: MCP and IP of the thumb; MCP, PIP and DIP of the others.
constexpr int bends_of(int finger) { return finger == 0 ? 2 : kBends; }
/// The position of a joint.
inline glm::vec3 joint_position(const JointFrames& frames, int joint) {
  return glm::vec3(frames[joint][3]);
}
/// The joint at which bend `i` of a finger is, and the finger's tip.
/// @{
constexpr int bend_joint(int finger, int i) { return kMetacarpalJoint[finger] + 1 + i; }
constexpr int tip_joint(int finger) { return bend_joint(finger, bends_of(finger)); }
/// @}
/// The finger whose phalanx or tip a joint is; -1 for the palm, the metacarpals and the wrist.
constexpr int finger_of_joint(int joint) {
  for (int f = 0; f < kFingers; ++f)
    if (joint >= bend_joint(f, 0) && joint <= tip_joint(f)) return f;
  return -1;
}

/// Angles by finger and joint, in radians; positive towards the palm.
using Flexion = std::array<std::array<double, kBends>, kFingers>;

/// The mirror image in x of a hand: the frames of the other side.
JointFrames mirrored(JointFrames frames);
/// The person's hand at rest, wrist at the origin, metres.
JointFrames rest_pose(renderer::Side side, const renderer::HandShape& person);
/// The flexion of a hand: the angle of each bone to the one before it, in the plane across their
/// common hinge.
Flexion flexion_of(const JointFrames& frames);
/// Bends the joints by `more`, from the palm to the tips. All bones keep their lengths.
JointFrames bent_by(const JointFrames& frames, const Flexion& more);
/// The hand whose fingers are `share` of the way (0..1) from those of `frames` to those of `rest`,
/// along the shortest rotation of each joint. The wrist and the lengths of the bones are those of
/// `frames`. `rest`: a hand of the same side.
JointFrames nearer_to(const JointFrames& frames, const JointFrames& rest, double share);
/// The axes of the palm by its joints: across to the index finger, out of the back, and from the
/// wrist to the middle knuckle.
glm::mat3 palm_axes(const JointFrames& frames);
/// The pose of `frames` for a hand whose bones have the lengths of `rest`, of the same side: the
/// bases of the metacarpals are fixed to the wrist, each knuckle is in the same direction from
/// there (the thumb's from its base), and each phalanx points in the same direction.
JointFrames with_bones_of(const JointFrames& rest, const JointFrames& frames);
/// The index and the middle finger become one: from the PIP to the tip, both get the mean of the
/// two.
JointFrames merged(const JointFrames& frames);

}  // namespace handcast::twin
