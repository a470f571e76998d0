// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/training/dice.hpp"
#include "services/lab/twin/articulation.hpp"

namespace handcast::landmarks::training {

/// Parts of the skin that reflect differently.
enum class Skin : std::uint8_t { plain, nail, knuckle, crease };

/// One person's right hand.
struct Person {
  renderer::HandMesh mesh;                        ///< the surface and the joints at rest
  twin::Articulation articulation;                ///< how its joints bend
  std::array<float, renderer::kJoints> radius_m;  ///< of the flesh around each joint
  std::vector<Skin> skin;                         ///< of each vertex
  std::vector<float> behind_m;                    ///< distance of each vertex behind the wrist
};

/// Draws hands that differ in the lengths of fingers and palm and in their widths. Takes a quarter
/// of a second for each. Errors: the hand model cannot be read.
Result<std::vector<Person>> draw_people(int count, std::uint64_t seed);

/// The joints at the wrist, at the root of each finger's first phalanx and at its tip, thumb first.
/// @{
inline constexpr int kWristJoint = 1;
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

/// Draws a pose: relaxed, spread, each finger on its own, fists, pinches. No finger penetrates
/// another one or the palm.
Pose draw_pose(Dice& dice, const Person& person);

/// True if a finger is deeper in another one or in the palm than flesh can be compressed.
bool penetrates(const Person& person, const renderer::JointFrames& joints);

}  // namespace handcast::landmarks::training
