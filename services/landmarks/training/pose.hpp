// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/training/people.hpp"

namespace handcast::landmarks::training {

/// The angles of a hand: those of the twin, and how far each finger is turned about its length
/// (radians), because few fingers bend straight towards the palm.
struct Posture {
  twin::Bend bend;
  std::array<float, 5> roll{};
};

/// A posture and its joints in the axes of the wrist (metres).
struct Pose {
  Posture posture;
  renderer::JointFrames joints;
};

/// The pose of a person in this posture.
Pose pose_of(const Person& person, const Posture& posture);

/// Draws a pose: relaxed, spread, each finger on its own, fists, pinches. No finger penetrates
/// another one or the palm.
Pose draw_pose(Dice& dice, const Person& person);

/// Whether a finger is deeper in another one or in the palm than flesh can be pressed.
bool penetrates(const Person& person, const renderer::JointFrames& joints);

}  // namespace handcast::landmarks::training
