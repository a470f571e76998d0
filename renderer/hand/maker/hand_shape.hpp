// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// The person: what the hand is made from. Left hand, palm down, millimetres, wrist at the origin:
/// +x thumb side, +y back of the hand, -z to the tips. Fingers: thumb, index, middle, ring, little.
struct HandShape {
  std::array<glm::vec3, 5> metacarpal_mm;  ///< base of the metacarpal (thumb: CMC joint)
  std::array<glm::vec3, 5> proximal_mm;    ///< MCP joint
  std::array<std::array<float, 3>, 5>
      phalanx_mm;  ///< lengths, the last one to the skin of the tip (thumb: two, then 0)
  std::array<float, 5> splay_deg;                   ///< in the palm's plane, + to the thumb
  std::array<std::array<float, 3>, 5> flexion_deg;  ///< at rest, per joint
  std::array<std::array<float, 4>, 5> radius_mm;    ///< MCP PIP DIP tip (thumb: CMC MCP IP tip)
  float palm_half_thickness_mm = 12;
  glm::vec2 wrist_half_axes_mm{28.5f, 17.5f};
  float forearm_mm = 80;  ///< stub beyond the wrist

  static HandShape mean();

  /// Bone lengths and widths scaled: `length[f]` per finger, `palm` for the metacarpals' frame,
  /// `width` for every radius and thickness.
  HandShape scaled(const std::array<float, 5>& length, float palm, float width) const;
};

/// The 26 joints at rest of a left hand of this shape (metres).
JointFrames rest_frames(const HandShape& shape);

/// From each joint to the skin, as a tracker reports it (metres).
std::array<float, kJoints> joint_radii_m(const HandShape& shape);

/// Width over height of the picture the texture coordinates are laid out for (1024 x 640); its
/// gutter is 8 of 1024 pixels.
inline constexpr float kAtlasAspect = 1.6f;

/// Makes the hand of `shape` from scratch (about a second): distance field -> fixed two-sheet quad
/// template -> relaxation, weights by heat diffusion, two UV charts by ARAP.
HandMesh make_hand(const HandShape& shape, Side side);

/// The same topology, texture coordinates and weights on another person (about a quarter of a
/// second).
HandMesh refit_hand(const HandMesh& mean, const HandShape& shape);

}  // namespace handcast::renderer
