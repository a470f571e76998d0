// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Sparse>
#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace handcast::renderer {

/// Half the cotangent of each corner of a triangle (the weight of the opposite edge), kept within
/// what a solver bears.
std::array<double, 3> half_cotangents(const std::array<glm::dvec3, 3>& corners);

/// The positive cotangent Laplacian of a triangle mesh and the area around each vertex.
struct MeshOperators {
  Eigen::SparseMatrix<double> laplacian;
  Eigen::VectorXd area;
};
MeshOperators mesh_operators(const std::vector<glm::dvec3>& points,
                             const std::vector<std::array<int, 3>>& triangles);

}  // namespace handcast::renderer
