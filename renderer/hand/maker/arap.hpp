// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace handcast::renderer {

/// Flattens an open chart as rigidly as possible, starting from `flat` (Liu et al. 2008, "A
/// Local/Global Approach to Mesh Parameterization", section 4): each triangle's best rotation, then
/// one linear solve, in turns. Keeps the scale.
void flatten_as_rigid_as_possible(const std::vector<glm::dvec3>& points,
                                  const std::vector<std::array<int, 3>>& triangles,
                                  std::vector<glm::dvec2>& flat, int rounds);

}  // namespace handcast::renderer
