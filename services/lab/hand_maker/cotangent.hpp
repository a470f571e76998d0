// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Sparse>
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace handcast::renderer {

/// Half the cotangent of each corner of a triangle, which is the weight of the opposite edge.
/// Clamped to [0.01, 20] to keep linear systems well conditioned.
std::array<double, 3> half_cotangents(const std::array<glm::dvec3, 3>& corners);

/// Discrete operators of a triangle mesh.
struct MeshOperators {
  Eigen::SparseMatrix<double> laplacian;  ///< cotangent Laplacian, positive semidefinite
  Eigen::VectorXd area;                   ///< by vertex: a third of its triangles, unit of points^2
};
/// Computes the operators. Triangles hold vertex indices.
MeshOperators mesh_operators(const std::vector<glm::dvec3>& points,
                             const std::vector<std::array<int, 3>>& triangles);

}  // namespace handcast::renderer
