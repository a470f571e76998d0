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

}  // namespace handcast::twin
