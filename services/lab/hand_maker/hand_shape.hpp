// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// The shape of a person's hand at rest: a left hand, palm down, wrist at the origin. +x points to
/// the thumb, +y out of the back of the hand, -z to the tips. Finger order: thumb, index, middle,
/// ring, little.
struct HandShape {
  std::array<glm::vec3, 5> metacarpal_mm;  ///< base of the metacarpal (thumb: CMC joint)
  std::array<glm::vec3, 5> proximal_mm;    ///< MCP joint
  /// Lengths of the phalanges, the last one to the skin of the tip (thumb: two, then 0).
  std::array<std::array<float, 3>, 5> phalanx_mm;
  std::array<float, 5> splay_deg;                   ///< in the plane of the palm, + to the thumb
  std::array<std::array<float, 3>, 5> flexion_deg;  ///< by finger and joint
  std::array<std::array<float, 4>, 5> radius_mm;    ///< MCP PIP DIP tip (thumb: CMC MCP IP tip)
  float palm_half_thickness_mm = 12;                ///< half the distance from back to palm
  glm::vec2 wrist_half_axes_mm{28.5f, 17.5f};       ///< of the wrist's oval: lateral, dorsal
  float forearm_mm = 80;                            ///< length of the stub behind the wrist

  /// The mean person.
  static HandShape mean();

  /// A copy with scaled lengths and widths: `length[f]` scales the phalanges of finger f, `palm`
  /// the positions of the metacarpals and MCP joints, `width` all radii and thicknesses.
  HandShape scaled(const std::array<float, 5>& length, float palm, float width) const;
};

/// The 26 joints of a left hand of this shape at rest, in metres.
JointFrames rest_frames(const HandShape& shape);

/// The distance from each joint to the skin, as reported by a tracker, in metres.
std::array<float, kJoints> joint_radii_m(const HandShape& shape);

/// Aspect ratio of the picture for which the texture coordinates are laid out: 1024 x 640 pixels,
/// with a gutter of 8 pixels.
inline constexpr float kAtlasAspect = 1.6f;

/// Makes the mesh of a hand, which takes about a second. The vertices of GloveTemplate are placed
/// on the skin of HandField and relaxed; the weights come from heat diffusion, the two UV charts
/// from an as-rigid-as-possible parameterization.
HandMesh make_hand(const HandShape& shape, Side side);

/// Fits the mesh of the mean hand to another person, which takes about a quarter of a second. The
/// topology, the texture coordinates and the weights are kept. A mesh that is not of make_hand() is
/// only posed by its own weights.
HandMesh refit_hand(const HandMesh& mean, const HandShape& shape);

}  // namespace handcast::renderer
