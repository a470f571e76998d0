// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/part_weights.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace handcast::twin {
namespace {

using renderer::kJoints;
using ByJoint = std::array<float, kJoints>;

constexpr double kReach_mm = 2.5;  ///< a part that is farther by this has 1/e of the share
constexpr int kRounds = 6;         ///< of averaging over neighbours

/// Adds `share` to the joints of a part at a place along it.
void add_joints(const Part& part, double along_mm, double share, ByJoint& weights) {
  double rest = 1;
  for (std::size_t k = 0; k < part.moved_by.size(); ++k) {
    double beyond = 0;
    if (k + 1 < part.moved_by.size()) {
      const double from_mm = part.moved_by[k + 1].from_mm;
      beyond = glm::smoothstep(from_mm - part.blend_mm, from_mm + part.blend_mm, along_mm);
    }
    weights[static_cast<std::size_t>(part.moved_by[k].joint)] +=
        static_cast<float>(share * (rest - std::min(rest, beyond)));
    rest = std::min(rest, beyond);
  }
}

ByJoint shared_by(std::span<const Part> parts, const glm::dvec3& point_mm) {
  std::vector<double> distance_mm;
  for (const auto& part : parts) distance_mm.push_back(part.limb.distance_mm(point_mm));
  const double nearest = *std::ranges::min_element(distance_mm);
  ByJoint weights{};
  for (std::size_t k = 0; k < parts.size(); ++k)
    add_joints(parts[k], parts[k].limb.along_mm(point_mm),
               std::exp((nearest - distance_mm[k]) / kReach_mm), weights);
  return weights;
}

void average_neighbours(const renderer::HandMesh& mesh, std::vector<ByJoint>& weights) {
  std::vector<ByJoint> sums = weights;
  std::vector<float> counts(weights.size(), 1);
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = triangle[k], next = triangle[(k + 1) % 3];
      for (std::size_t j = 0; j < kJoints; ++j) sums[v][j] += weights[next][j];
      ++counts[v];
    }
  for (std::size_t v = 0; v < weights.size(); ++v)
    for (std::size_t j = 0; j < kJoints; ++j) weights[v][j] = sums[v][j] / counts[v];
}

void keep_four(const ByJoint& all, std::array<std::uint8_t, 4>& joints,
               std::array<float, 4>& weights) {
  std::array<std::uint8_t, kJoints> order;
  std::iota(order.begin(), order.end(), std::uint8_t{0});
  std::ranges::stable_sort(order, [&](auto a, auto b) { return all[a] > all[b]; });
  float sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += all[order[k]];
  for (std::size_t k = 0; k < 4; ++k) {
    joints[k] = order[k];
    weights[k] = all[order[k]] / sum;
  }
}

}  // namespace

void set_part_weights(renderer::HandMesh& mesh, std::span<const Part> parts) {
  std::vector<ByJoint> weights;
  for (const glm::vec3& position : mesh.positions) {
    weights.push_back(shared_by(parts, glm::dvec3(position) * 1e3));
    const float sum = std::accumulate(weights.back().begin(), weights.back().end(), 0.0f);
    for (float& weight : weights.back()) weight /= sum;
  }
  for (int round = 0; round < kRounds; ++round) average_neighbours(mesh, weights);
  mesh.joints.resize(mesh.vertex_count());
  mesh.weights.resize(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    keep_four(weights[v], mesh.joints[v], mesh.weights[v]);
}

}  // namespace handcast::twin
