// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace handcast::renderer {

/// Flattens an open chart as rigidly as possible, in the scale of `points` (Liu et al. 2008, "A
/// Local/Global Approach to Mesh Parameterization", section 4). Each round computes the best
/// rotation of each triangle and then solves one linear system. `flat` holds the initial and the
/// resulting positions, by vertex.
void flatten_as_rigid_as_possible(const std::vector<glm::dvec3>& points,
                                  const std::vector<std::array<int, 3>>& triangles,
                                  std::vector<glm::dvec2>& flat, int rounds);

}  // namespace handcast::renderer
