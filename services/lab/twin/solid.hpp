// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace handcast::twin {

/// A closed surface other than a hand. Metres.
struct Solid {
  std::vector<glm::vec3> positions;                     ///< by vertex
  std::vector<glm::vec3> normals;                       ///< by vertex
  std::vector<std::array<std::uint16_t, 3>> triangles;  ///< counter-clockwise seen from outside
};
/// Makes an ellipsoid around `middle` whose axes are those of the space.
Solid make_ellipsoid(const glm::vec3& middle, const glm::vec3& half_axes);

/// The bright thing that a hand holds across its palm, as wide as three fingers, in the axes of the
/// palm joint.
Solid make_held_object();
/// Its brightness relative to skin.
inline constexpr float kObjectBrightness = 1.3f;

/// A retro-reflector on the tip of a finger, in the axes of camera space around the tip.
Solid make_reflector(double diameter_m);
/// Its grey value, whatever the angle of the light.
inline constexpr float kReflectorGrey = 1000;
/// It is taped around the finger tip, so it is drawn this much nearer to the camera: flesh of the
/// finger tip itself does not hide it, and other flesh does.
inline constexpr float kReflectorNearer_m = 0.012f;

/// Standard deviation of the blur of the mirror image: the table is glossy, not a mirror.
inline constexpr double kTableBlur_px = 4;

/// Reflects a surface in the glossy table: a plane 0.15 m behind the hands' nominal distance,
/// tilted by 10 degrees so that the mirror image shows beside the fingers. Camera axes, metres. The
/// triangles turn from counter-clockwise to clockwise.
void mirror_in_table(std::span<glm::vec3> positions, std::span<glm::vec3> normals);

}  // namespace handcast::twin
