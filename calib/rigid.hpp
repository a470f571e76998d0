// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::calib {

/// The rigid transform next to one whose axes are a little off: x keeps its direction, y its plane,
/// z follows (right-handed).
glm::dmat4 orthonormalised(const glm::dmat4& transform);

/// The largest difference of an axis component from the orthonormalised transform; about 2 for a
/// mirrored one, infinite where the axes span no space.
double distance_from_rigid(const glm::dmat4& transform);

}  // namespace handcast::calib
