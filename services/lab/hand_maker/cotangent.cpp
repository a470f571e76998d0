// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/cotangent.hpp"

#include <algorithm>

namespace handcast::renderer {

std::array<double, 3> half_cotangents(const std::array<glm::dvec3, 3>& corners) {
  std::array<double, 3> half;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 u = corners[(k + 1) % 3] - corners[k], v = corners[(k + 2) % 3] - corners[k];
    half[k] = std::clamp(0.5 * glm::dot(u, v) / std::max(glm::length(glm::cross(u, v)), 1e-9), 0.01,
                         20.0);
  }
  return half;
}

MeshOperators mesh_operators(const std::vector<glm::dvec3>& points,
                             const std::vector<std::array<int, 3>>& triangles) {
  const auto count = static_cast<Eigen::Index>(points.size());
  MeshOperators operators{Eigen::SparseMatrix<double>(count, count), Eigen::VectorXd::Zero(count)};
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& t : triangles) {
    const std::array corners{points[t[0]], points[t[1]], points[t[2]]};
    const auto weight = half_cotangents(corners);
    const double sixth =
        glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) / 6;
    for (int k = 0; k < 3; ++k) {
      const int a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      entries.insert(
          entries.end(),
          {{a, b, -weight[k]}, {b, a, -weight[k]}, {a, a, weight[k]}, {b, b, weight[k]}});
      operators.area[t[k]] += sixth;
    }
  }
  operators.laplacian.setFromTriplets(entries.begin(), entries.end());
  return operators;
}  // NOLINT(clang-analyzer-unix.Malloc): Eigen's own memory

}  // namespace handcast::renderer
