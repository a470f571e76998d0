// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::calib {

/// The rigid transform nearest to one whose axes are slightly off: x keeps its direction, y its
/// plane with x, and z completes the right-handed axes.
glm::dmat4 orthonormalised(const glm::dmat4& transform);

/// The largest difference of an axis component from the orthonormalised transform: about 2 for a
/// mirrored one, infinite if the axes are linearly dependent.
double distance_from_rigid(const glm::dmat4& transform);

}  // namespace handcast::calib
