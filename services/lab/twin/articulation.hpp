// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "services/lab/hand_maker/hand_shape.hpp"

namespace handcast::twin {

/// Rotation of the joints relative to the rest pose, in radians. Finger order: thumb, index,
/// middle, ring, little.
struct Bend {
  /// Flexion towards the palm, by finger: MCP, PIP, DIP (thumb: MCP, IP, unused).
  std::array<std::array<double, 3>, 5> flexion{};
  std::array<double, 5> splay{};  ///< at the MCP, towards the thumb
  double thumb_flexion = 0;       ///< at the thumb's root, in the plane of its nail
  double thumb_opposition = 0;    ///< at the thumb's root, across the palm
  double thumb_roll = 0;          ///< at the thumb's root, about its own length
};

/// Forward kinematics of one person's hand. Only angles change: every bone keeps its length.
class Articulation {
 public:
  /// Copies the rest pose and the bone lengths of `shape`.
  explicit Articulation(const renderer::HandShape& shape);

  /// The joints of a hand whose wrist is at `space_from_wrist` (OpenXR hand axes, metres). A right
  /// hand is the mirror image in x of the left one.
  renderer::JointFrames frames(renderer::Side side, const glm::dmat4& space_from_wrist,
                               const Bend& bend) const;

 private:
  std::array<glm::dmat4, renderer::kJoints> parent_from_joint_;  ///< at rest
};

}  // namespace handcast::twin
