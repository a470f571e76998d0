// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/training/people.hpp"

namespace handcast::landmarks::training {

/// How a hand is held: the twin's angles, and how far each finger is turned about its own length
/// (radians), for few bend straight towards the palm.
struct Posture {
  twin::Bend bend;
  std::array<float, 5> roll{};
};

/// A posture and the joints it gives as seen from the wrist (metres).
struct Pose {
  Posture posture;
  renderer::JointFrames joints;
};

Pose pose_of(const Person& person, const Posture& posture);

/// Any pose a hand can take: relaxed, spread, every finger for itself, fists, pinches. Never one
/// with a finger inside another or in the palm.
Pose draw_pose(Dice& dice, const Person& person);

/// A finger is deeper in another one or in the palm than flesh gives way.
bool penetrates(const Person& person, const renderer::JointFrames& joints);

}  // namespace handcast::landmarks::training
