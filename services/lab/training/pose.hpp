// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "services/lab/training/dice.hpp"
#include "services/lab/training/flesh.hpp"
#include "services/lab/twin/articulation.hpp"

namespace handcast::landmarks::training {

/// One person's right hand.
struct Person {
  FleshModel flesh;                               ///< the surface and the joints at rest
  twin::Articulation articulation;                ///< how its joints bend
  std::array<float, renderer::kJoints> radius_m;  ///< of the flesh around each joint
};

/// Draws hands that differ in the lengths of fingers and palm and in their widths. Takes a quarter
/// of a second for each. Errors: the hand model cannot be read.
Result<std::vector<Person>> draw_people(int count, std::uint64_t seed);

/// The joints at the wrist, at the root of each finger's first phalanx and at its tip, thumb first.
/// @{
inline constexpr int kWristJoint = 1, kThumbRoot = 2;
inline constexpr std::array<int, 5> kFirstPhalanx{3, 7, 12, 17, 22};
inline constexpr std::array<int, 5> kTip{5, 10, 15, 20, 25};
/// @}

/// The angles of a hand. In addition to those of the twin, each finger is rotated about its length,
/// because few fingers bend straight towards the palm.
struct Posture {
  twin::Bend bend;              ///< the angles of the twin
  std::array<float, 5> roll{};  ///< rotation of each finger about its length, radians
};

/// A posture and its joints.
struct Pose {
  Posture posture;               ///< the angles
  renderer::JointFrames joints;  ///< the joints in the axes of the wrist (metres)
};

/// The pose of a person in this posture.
Pose pose_of(const Person& person, const Posture& posture);

/// Draws a pose: relaxed, spread, gripping, pointing, each finger on its own, fists, pinches. No
/// finger penetrates another one or the palm.
Pose draw_pose(Dice& dice, const Person& person);

/// Where a tracker and its person have their joints: displacements from those of the flesh, by
/// joint, in its axes (metres). Trackers define wrist and root of the thumb each in their own way.
using Definitions = std::array<glm::vec3, renderer::kJoints>;
Definitions draw_definitions(Dice& dice);
/// Joints with these displacements.
renderer::JointFrames defined(renderer::JointFrames joints, const Definitions& definitions);

/// True if a finger is deeper in another one or in the palm than flesh can be compressed.
bool penetrates(const Person& person, const renderer::JointFrames& joints);

}  // namespace handcast::landmarks::training
