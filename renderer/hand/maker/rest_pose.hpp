// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "renderer/hand/maker/hand_shape.hpp"

namespace handcast::renderer {

/// Fingers: 0 thumb, 1 index, 2 middle, 3 ring, 4 little.
inline constexpr int kFingers = 5;
/// The metacarpal of each finger; its phalanges and tip follow.
inline constexpr std::array<int, kFingers> kMetacarpal{2, 6, 11, 16, 21};
inline constexpr int tip_of(int finger) { return kMetacarpal[finger] + (finger == 0 ? 3 : 4); }
inline constexpr int phalanx_count(int finger) { return finger == 0 ? 2 : 3; }

/// The joints of a left hand at rest, in the millimetres and doubles the making of a hand works in.
struct RestPose {
  std::array<glm::dvec3, kJoints> position_mm{};
  std::array<glm::dmat3, kJoints> axes{};  ///< columns: lateral (to the thumb), dorsal, proximal
};

RestPose rest_pose(const HandShape& shape);

}  // namespace handcast::renderer
