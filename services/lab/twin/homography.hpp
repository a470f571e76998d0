// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

namespace handcast::twin {

/// The map from the projective basis (three axes and their sum) to four points.
inline glm::dmat3 from_basis(const std::array<glm::dvec2, 4>& points) {
  const glm::dmat3 axes(glm::dvec3(points[0], 1), glm::dvec3(points[1], 1),
                        glm::dvec3(points[2], 1));
  const glm::dvec3 scale = glm::inverse(axes) * glm::dvec3(points[3], 1);
  return {axes[0] * scale.x, axes[1] * scale.y, axes[2] * scale.z};
}

/// The homography that maps each `from` to its `to`, of any scale. No three points may be on one
/// line.
inline glm::dmat3 homography(const std::array<glm::dvec2, 4>& from,
                             const std::array<glm::dvec2, 4>& to) {
  return from_basis(to) * glm::inverse(from_basis(from));
}

}  // namespace handcast::twin
