// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/texture_map.hpp"

#include <algorithm>
#include <limits>

#include "renderer/base/triangle.hpp"

namespace handcast::twin {
namespace {

using renderer::HandMesh;

/// A triangle of the ground-truth mesh, prepared for searches: it lies in a sphere.
struct Facet {
  glm::vec3 middle;
  float radius;
};

std::vector<Facet> facets_of(const HandMesh& mesh) {
  std::vector<Facet> facets;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0f;
    float radius = 0;
    for (const auto v : {a, b, c})
      radius = std::max(radius, glm::distance(mesh.positions[v], middle));
    facets.push_back({middle, radius});
  }
  return facets;
}

SurfacePoint nearest_point(const HandMesh& mesh, const std::vector<Facet>& facets,
                           const glm::vec3& p) {
  SurfacePoint best{0, {1, 0, 0}};
  float best_m = std::numeric_limits<float>::max();
  for (std::size_t t = 0; t < facets.size(); ++t) {
    if (glm::distance(facets[t].middle, p) - facets[t].radius >= best_m) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    const SurfacePoint at{
        static_cast<std::uint16_t>(t),
        renderer::nearest_in_triangle(p, mesh.positions[a], mesh.positions[b], mesh.positions[c])};
    const float far_m = glm::distance(at.on(mesh, mesh.positions), p);
    if (far_m >= best_m) continue;
    best_m = far_m;
    best = at;
  }
  return best;
}

}  // namespace

std::vector<SurfacePoint> texture_map(const HandMesh& drawn, const HandMesh& truth) {
  const auto facets = facets_of(truth);
  std::vector<SurfacePoint> map;
  for (const glm::vec3& position : drawn.positions)
    map.push_back(nearest_point(truth, facets, position));
  return map;
}

std::vector<SurfacePoint> own_texture_map(const HandMesh& mesh) {
  std::vector<SurfacePoint> map(mesh.vertex_count());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      glm::vec3 share(0);
      share[k] = 1;
      map[mesh.triangles[t][k]] = {static_cast<std::uint16_t>(t), share};
    }
  return map;
}

}  // namespace handcast::twin
