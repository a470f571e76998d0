// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/implicit_hand.hpp"

#include <cmath>

#include "services/lab/twin/implicit/part_weights.hpp"
#include "services/lab/twin/implicit/parts.hpp"
#include "services/lab/twin/implicit/surface_nets.hpp"

namespace handcast::twin {
namespace {

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
