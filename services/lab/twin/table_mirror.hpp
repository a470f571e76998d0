// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>

namespace handcast::twin {

/// Standard deviation of the blur of the mirror image: the table is glossy, not a mirror.
inline constexpr double kTableBlur_px = 4;

/// Reflects a surface in the glossy table: a plane 0.15 m behind the hands' nominal distance,
/// tilted by 10 degrees so that the mirror image shows beside the fingers. Camera axes, metres. The
/// triangles turn from counter-clockwise to clockwise.
void mirror_in_table(std::span<glm::vec3> positions, std::span<glm::vec3> normals);

}  // namespace handcast::twin
