// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::pose {

inline constexpr int kFingers = 5;  ///< thumb, index, middle, ring, little
inline constexpr int kAngles = 4;   ///< of a finger
/// Palm, thumb's root, and the knuckles: the first joint of each finger that turns. The next two
/// turn, too; the fourth is the tip. Landmark 1 + 4 f + k is joint kFirstJoint[f] + k.
inline constexpr std::array<int, kFingers> kFirstJoint{2, 7, 12, 17, 22};
inline constexpr int kPalm = 0;   ///< XR joint
inline constexpr int kWrist = 1;  ///< XR joint

/// The degrees of freedom of a hand at a known distance.
struct Posture {
  glm::dquat turn{1, 0, 0, 0};  ///< camera from hand (OpenXR's hand axes)
  glm::dvec2 palm_m{0};         ///< x and y of the palm joint, camera space
  double log_size = 0;          ///< logarithm of the size relative to the model
  /// Rotations relative to the rest pose, in rad. 0: about the y axis of the first joint; 1 to 3:
  /// flexion of the first three joints, about their -x axes.
  std::array<std::array<double, kAngles>, kFingers> angle{};
};

/// The lengths of the bones that end at the first four joints of each finger (kFirstJoint),
/// relative to the model's at the hand's size.
using BoneFactors = std::array<std::array<double, kAngles>, kFingers>;

/// A hand in camera space, metres.
struct PosedHand {
  std::array<glm::dvec3, msg::kJoints> place_m;  ///< of the joints
  std::array<glm::dmat3, msg::kJoints> axes;     ///< of the joints: columns x, y, z
  /// The axes of rotation of the angles; they go through joint kFirstJoint[f] + max(0, k - 1).
  std::array<std::array<glm::dvec3, kAngles>, kFingers> hinge;
};

/// The bones of one side's hand model. Any thread.
class Skeleton {
 public:
  /// `hand`: its rest pose gives the lengths and the axes of the bones.
  explicit Skeleton(const renderer::HandMesh& hand);

  /// The joints of a hand whose palm joint is `distance_m` in front of the camera.
  PosedHand posed(const Posture& posture, double distance_m) const;
  /// The same for a person whose bones have other lengths.
  PosedHand posed(const Posture& posture, double distance_m, const BoneFactors& factors) const;
  /// From the wrist to the tip of the middle finger, along the bones.
  double length_m() const { return length_m_; }
  /// A joint in the space of the hand at rest, relative to the palm joint.
  glm::dvec3 at_rest_m(int joint) const { return from_palm_m_[joint]; }
  /// Distance from the joint to the skin at rest.
  double radius_m(int joint) const { return radius_m_[joint]; }

 private:
  std::array<glm::dvec3, msg::kJoints> from_palm_m_, from_parent_m_;
  std::array<glm::dmat3, msg::kJoints> axes_, parent_from_joint_;
  std::array<double, msg::kJoints> radius_m_{};
  double length_m_ = 0;
};

}  // namespace handcast::pose
