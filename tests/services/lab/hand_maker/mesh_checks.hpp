// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "services/lab/hand_maker/hand_shape.hpp"

namespace handcast::renderer::samples {

/// The mean hands, made once per test program.
const HandMesh& mean_hand(Side side);
/// Another person: longer fingers, slimmer.
HandShape another_person();

/// Per vertex the first vertex in the same place.
std::vector<int> welded(const HandMesh& hand);
/// Edges that not exactly two triangles share, in opposite directions, once vertices in the same
/// place are one.
int open_edges(const HandMesh& hand);
/// The fewest neighbours a welded vertex has.
int least_valence(const HandMesh& hand);
/// Pairs of triangles without a common vertex that cut each other.
int self_intersections(const HandMesh& hand, const std::vector<glm::vec3>& positions);
/// Triangles whose front looks against the normals of their vertices.
int flips(const HandMesh& hand);
double volume_m3(const HandMesh& hand, const std::vector<glm::vec3>& positions);

/// Per triangle: long over short axis of what a circle of the texture becomes on the skin, sorted.
std::vector<double> stretch_ratios(const HandMesh& hand);
/// Pixels of a fine picture that more than one triangle covers.
int uv_overlaps(const HandMesh& hand);
double percentile(const std::vector<double>& sorted, double share);

}  // namespace handcast::renderer::samples
