// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::renderer {

/// The 26 joints of a hand, m.
using JointPlaces = std::span<const glm::vec3, msg::kJoints>;

/// How a hand is held, independent of its size: L is the distance from the wrist to the middle
/// knuckle, S is smoothstep, which is 0 up to its first and 1 from its second number on.
struct HandPosture {
  float pinch = 0;  ///< 1 - S(0.2, 0.65) of the distance of the tips of thumb and index finger by L
  /// S(1.05, 1.5) of the distance of the middle joints (PIP) of index and little finger by that of
  /// their knuckles. Fingers that bend count as closed.
  float spread = 0;
  float curl = 0;  ///< 1 - S(0.45, 0.95) of the mean of `reach`
  /// The distance from the wrist to the tip of index to little finger, by the length of the way
  /// along the joints: 1 for a finger that is straight.
  std::array<float, 4> reach{};
};

/// The shape of a hand.
HandPosture posture_of(JointPlaces joints);
/// The axes of a palm as columns: x to the right, y out of the back, z to the arm.
glm::mat3 palm_axes(JointPlaces joints, msg::Side side);

}  // namespace handcast::renderer
