// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
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

}  // namespace handcast::twin
