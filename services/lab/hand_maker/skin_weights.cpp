// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/skin_weights.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <numeric>

#include "services/lab/hand_maker/cotangent.hpp"

namespace handcast::renderer {
namespace {

constexpr int kWrist = 1;
constexpr double kLeastWeight = 0.01;  ///< smaller weights are dropped

double distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 ab = b - a;
  const double share = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
  return glm::distance(p, a + ab * share);
}

/// The bone, given by the joint at its start, to which a vertex belongs: for palm vertices the
/// forearm, a metacarpal or the proximal phalanx of a finger other than the thumb; for finger
/// vertices a bone of their own finger.
int nearest_bone(const glm::dvec3& p, int finger_of_vertex, const RestPose& rest) {
  constexpr double kMetacarpalHandicap = 2;  // mm: favours the phalanges for the skin of a finger
  const bool in_palm = finger_of_vertex < 0;
  int best = kWrist;
  double least = in_palm ? distance_to_segment(p, {0, 0, -4}, {0, 0, 1000})
                         : std::numeric_limits<double>::max();
  for (int f = 0; f < kFingers; ++f) {
    if (!in_palm && f != finger_of_vertex) continue;
    const int last_bone =
        in_palm ? std::min(kMetacarpal[f] + (f == 0 ? 0 : 1), tip_of(f) - 1) : tip_of(f) - 1;
    for (int joint = kMetacarpal[f]; joint <= last_bone; ++joint) {
      double distance =
          distance_to_segment(p, rest.position_mm[joint], rest.position_mm[joint + 1]);
      if (!in_palm && f > 0 && joint == kMetacarpal[f]) distance += kMetacarpalHandicap;
      if (distance < least) least = distance, best = joint;
    }
  }
  return best;
}

/// Diffuses `columns` by two implicit heat steps over a distance of about `reach_mm`.
Eigen::MatrixXd spread(const MeshOperators& operators, const Eigen::MatrixXd& columns,
                       double reach_mm) {
  Eigen::SparseMatrix<double> system = operators.laplacian * (reach_mm * reach_mm / 2);
  system.diagonal() += operators.area;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
  Eigen::MatrixXd spread = columns;
  for (int step = 0; step < 2; ++step)
    spread = solver.solve(operators.area.asDiagonal() * spread).eval();
  return spread;
}

VertexWeights best_four(const Eigen::RowVectorXd& row) {
  std::array<int, kJoints> order;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return row[a] > row[b]; });
  VertexWeights best;
  float sum = 0;
  for (int k = 0; k < 4; ++k) {
    if (row[order[k]] < kLeastWeight) break;
    best.joints[k] = static_cast<std::uint8_t>(order[k]);
    sum += best.weights[k] = static_cast<float>(row[order[k]]);
  }
  for (float& weight : best.weights) weight /= sum;
  return best;
}

}  // namespace

std::vector<VertexWeights> skin_weights(const SkinPoints& points,
                                        const std::vector<Triangle>& triangles,
                                        const GloveTemplate& glove, const RestPose& rest) {
  constexpr double kFingerReach = 3.2, kPalmReach = 8, kChangeover = 4;  // mm
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd bone = Eigen::MatrixXd::Zero(count, kJoints),
                  in_palm = Eigen::MatrixXd::Zero(count, 1);
  for (int v = 0; v < count; ++v) {
    const int finger = glove.sheet()[glove.sheet_of_glued(v)].finger;
    bone(v, nearest_bone(points[v], finger, rest)) = 1;
    in_palm(v, 0) = finger < 0 ? 1 : 0;
  }
  const MeshOperators operators = mesh_operators(points, triangles);
  const Eigen::ArrayXd palm_share = spread(operators, in_palm, kChangeover).col(0).array();
  const Eigen::MatrixXd narrow = spread(operators, bone, kFingerReach),
                        wide = spread(operators, bone, kPalmReach);
  std::vector<VertexWeights> weights;
  for (Eigen::Index v = 0; v < count; ++v)
    weights.push_back(best_four(narrow.row(v) * (1 - palm_share[v]) + wide.row(v) * palm_share[v]));
  return weights;
}

}  // namespace handcast::renderer
