// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "services/lab/hand_maker/hand_shape.hpp"

namespace handcast::renderer {

/// Number of fingers: 0 thumb, 1 index, 2 middle, 3 ring, 4 little.
inline constexpr int kFingers = 5;
/// The XR joint of each finger's metacarpal. Those of its phalanges and tip follow.
inline constexpr std::array<int, kFingers> kMetacarpal{2, 6, 11, 16, 21};
/// The XR joint of a finger's tip.
inline constexpr int tip_of(int finger) { return kMetacarpal[finger] + (finger == 0 ? 3 : 4); }
/// Number of a finger's phalanges.
inline constexpr int phalanx_count(int finger) { return finger == 0 ? 2 : 3; }

/// The joints of a left hand at rest, in the unit and precision of the hand maker.
struct RestPose {
  std::array<glm::dvec3, kJoints> position_mm{};  ///< by XR joint; the wrist is the origin
  std::array<glm::dmat3, kJoints> axes{};  ///< columns: lateral (to the thumb), dorsal, proximal
};

/// The rest pose of a shape.
RestPose rest_pose(const HandShape& shape);

}  // namespace handcast::renderer
