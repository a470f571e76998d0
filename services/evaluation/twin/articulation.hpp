// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "renderer/hand/maker/hand_shape.hpp"

namespace handcast::twin {

/// How far the joints are bent beyond the rest pose, radians. Fingers: thumb, index, middle, ring,
/// little.
struct Bend {
  std::array<std::array<double, 3>, 5>
      flexion{};                  ///< towards the palm: MCP PIP DIP (thumb: MCP IP, then unused)
  std::array<double, 5> splay{};  ///< towards the thumb
  double thumb_flexion = 0;       ///< at the thumb's root, in the plane of its nail
  double thumb_opposition = 0;    ///< at the thumb's root, across the palm
  double thumb_roll = 0;          ///< at the thumb's root, about its own length
};

/// Forward kinematics of one person's hand. Only angles change: every bone keeps its length.
class Articulation {
 public:
  explicit Articulation(const renderer::HandShape& shape);

  /// The joints where the wrist stands at `space_from_wrist` (OpenXR hand axes, metres). A right
  /// hand is the left one mirrored in x.
  renderer::JointFrames frames(renderer::Side side, const glm::dmat4& space_from_wrist,
                               const Bend& bend) const;

 private:
  std::array<glm::dmat4, renderer::kJoints> parent_from_joint_;  ///< at rest
};

}  // namespace handcast::twin
