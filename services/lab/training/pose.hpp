// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/lab/training/people.hpp"

namespace handcast::landmarks::training {

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
