// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::renderer {

/// How one joint goes on from the newest sample.
struct JointStep {
  glm::vec3 moved_m{0};          ///< displacement, tracker space
  glm::quat turned{1, 0, 0, 0};  ///< the new orientation
  float belief = 1;              ///< 0: the joint's motion is impossible and left out; 1: usual
};

/// An earlier sample of the same hand.
struct PoseBefore {
  const msg::HandPose& pose;
  float since_s;  ///< from it to the newest sample; positive
};

/// The joints `ahead_s` after the newest sample at constant velocity: that since `older`, which has
/// less noise, as far as the one since `recent` does not contradict it. A joint whose two
/// velocities differ by more than a finger can accelerate, relative to the palm, has snapped: it
/// goes with the palm.
std::array<JointStep, msg::kJoints> steps_ahead(const msg::HandPose& newest,
                                                const PoseBefore& recent, const PoseBefore& older,
                                                float ahead_s);

}  // namespace handcast::renderer
