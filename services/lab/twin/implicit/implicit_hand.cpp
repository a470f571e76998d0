// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/implicit_hand.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "services/lab/twin/implicit/parts.hpp"
#include "services/lab/twin/implicit/surface_nets.hpp"

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

/// Sets the skin weights of a mesh at rest, whose positions are in metres: the parts share each
/// vertex by their distances to it, and the joints of a part share it by its place along the part.
/// Neighbours are averaged, and the four largest weights remain.
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

using renderer::HandMesh;

constexpr double kGrid_mm = 3.5;
/// How far the parts of the palm, and then palm and fingers, flow into each other.
constexpr double kPalmBlend_mm = 5, kFingerBlend_mm = 2.4;

/// Smooth union: -k log(sum of exp(-distance / k)).
class Union {
 public:
  explicit Union(double blend_mm) : blend_mm_(blend_mm) {}
  void add(double distance_mm) { sum_ += std::exp(-distance_mm / blend_mm_); }
  double distance_mm() const { return -blend_mm_ * std::log(std::max(sum_, 1e-300)); }

 private:
  double blend_mm_, sum_ = 0;
};

/// The parts of the hand: the fingers first.
std::vector<Part> parts_of(const renderer::HandShape& shape) {
  const auto rest = renderer::rest_pose(shape);
  auto parts = palm_parts(shape, rest);
  for (int f = renderer::kFingers - 1; f >= 0; --f)
    parts.insert(parts.begin(), finger_part(shape, rest, f));
  return parts;
}

double skin_of(const std::vector<Part>& parts, const glm::dvec3& point) {
  Union palm(kPalmBlend_mm), hand(kFingerBlend_mm);
  for (std::size_t k = renderer::kFingers; k < parts.size(); ++k)
    palm.add(parts[k].limb.distance_mm(point));
  hand.add(palm.distance_mm());
  for (std::size_t f = 0; f < renderer::kFingers; ++f) hand.add(parts[f].limb.distance_mm(point));
  return hand.distance_mm();
}

HandMesh make() {
  const auto shape = implicit_shape();
  const auto parts = parts_of(shape);
  const Field field = [&](const glm::dvec3& point) { return skin_of(parts, point); };
  const auto surface = surface_net(field, {-90, -50, -215}, {110, 40, 75}, kGrid_mm);
  HandMesh mesh;
  for (const auto& point : surface.points) {
    mesh.positions.emplace_back(point * 1e-3);
    mesh.normals.emplace_back(glm::normalize(gradient_of(field, point)));
  }
  mesh.uv.resize(mesh.vertex_count());
  mesh.chart.assign(mesh.vertex_count(), 1);
  mesh.triangles = surface.triangles;
  mesh.rest = renderer::rest_frames(shape);
  set_part_weights(mesh, parts);
  return mesh;
}

}  // namespace

const HandMesh& implicit_hand() {
  static const HandMesh hand = make();
  return hand;
}

}  // namespace handcast::twin
