// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/twin/texture_map.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>

#include "services/evaluation/twin/surface.hpp"

namespace handcast::twin {
namespace {

using renderer::HandMesh;

constexpr int kRounds = 16;
constexpr int kSmoothest = 24;  ///< means over the neighbours in the first round; 0 in the last
constexpr float kFarthest_m = 0.02f;  ///< a nearest point farther away is not followed
constexpr float kCap_m = 0.01f;       ///< the end of the flesh behind the wrist, which closes it
constexpr float kFacing = 0.2f;       ///< least cosine between normals

/// Vertices at the same place as one: a texture's seam cuts the mesh, not the hand.
struct Glued {
  std::vector<std::size_t> of_vertex;          ///< by vertex of the mesh
  std::vector<std::size_t> first;              ///< by glued vertex: a vertex of the mesh
  std::vector<std::vector<std::size_t>> near;  ///< by glued vertex: its neighbours
};

Glued glue(const HandMesh& mesh) {
  Glued glued;
  std::map<std::tuple<float, float, float>, std::size_t> at;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const glm::vec3& p = mesh.positions[v];
    const auto [entry, is_new] = at.try_emplace({p.x, p.y, p.z}, glued.first.size());
    if (is_new) glued.first.push_back(v);
    glued.of_vertex.push_back(entry->second);
  }
  glued.near.resize(glued.first.size());
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
        glued.near[glued.of_vertex[triangle[k]]].push_back(glued.of_vertex[triangle[other]]);
  return glued;
}

/// The barycentric coordinates of the point of a triangle that is nearest to `p` (Ericson 2004,
/// "Real-Time Collision Detection", section 5.1.5).
glm::vec3 nearest_in(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b,
                     const glm::vec3& c) {
  const glm::vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp),
              d4 = glm::dot(ac, bp), d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const float whole = va + vb + vc;
  return {va / whole, vb / whole, vc / whole};
}

/// The flesh, prepared for searches.
class Target {
 public:
  explicit Target(const HandMesh& mesh) : mesh_(mesh) {
    const auto fingers = fingers_of(mesh);
    for (const auto& [a, b, c] : mesh.triangles) {
      const glm::vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0f;
      float radius = 0;
      for (const auto v : {a, b, c})
        radius = std::max(radius, glm::distance(mesh.positions[v], middle));
      const glm::vec3 normal =
          glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
      const float length = glm::length(normal);
      facets_.push_back({middle, length > 0 ? normal / length : glm::vec3(0), radius, fingers[a]});
    }
  }

  /// The nearest point to `p` that faces as `normal` and is on `finger` or the palm.
  SurfacePoint nearest(const glm::vec3& p, const glm::vec3& normal, int finger,
                       std::uint16_t guess) const {
    SurfacePoint best{guess, {1, 0, 0}};
    float best_m = std::numeric_limits<float>::max();
    const auto look_at = [&](std::size_t t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      const SurfacePoint at{
          static_cast<std::uint16_t>(t),
          nearest_in(p, mesh_.positions[a], mesh_.positions[b], mesh_.positions[c])};
      const float far_m = glm::distance(at.on(mesh_, mesh_.positions), p);
      if (far_m >= best_m) return;
      best_m = far_m;
      best = at;
    };
    if (fits(facets_[guess], normal, finger)) look_at(guess);
    for (std::size_t t = 0; t < facets_.size(); ++t) {
      const Facet& facet = facets_[t];
      const glm::vec3 d = facet.middle - p;
      const float reach = best_m < 1 ? best_m + facet.radius : 2;
      if (glm::dot(d, d) < reach * reach && fits(facet, normal, finger)) look_at(t);
    }
    return best;
  }

  glm::vec3 place(const SurfacePoint& point) const { return point.on(mesh_, mesh_.positions); }

 private:
  struct Facet {
    glm::vec3 middle, normal;
    float radius;
    int finger;
  };
  static bool fits(const Facet& facet, const glm::vec3& normal, int finger) {
    return glm::dot(facet.normal, normal) > kFacing &&
           (facet.finger == finger || facet.finger < 0 || finger < 0);
  }

  const HandMesh& mesh_;
  std::vector<Facet> facets_;
};

/// Replaces each value by the mean of it and its neighbours', `times` times.
void smooth(const Glued& glued, std::vector<glm::vec3>& values, int times) {
  for (; times > 0; --times) {
    std::vector<glm::vec3> means = values;
    for (std::size_t g = 0; g < values.size(); ++g) {
      for (const std::size_t other : glued.near[g]) means[g] += values[other];
      means[g] /= static_cast<float>(glued.near[g].size() + 1);
    }
    values = std::move(means);
  }
}

}  // namespace

std::vector<SurfacePoint> texture_map(const HandMesh& drawn, const HandMesh& flesh) {
  const Glued glued = glue(drawn);
  const Target target(flesh);
  const auto fingers = fingers_of(drawn);
  const auto behind_m = behind_wrist_m(drawn);
  const float cap_m = std::ranges::max(behind_wrist_m(flesh)) - kCap_m;
  const std::size_t count = glued.first.size();
  std::vector<glm::vec3> at(count), steps(count);
  std::vector<SurfacePoint> found(count);
  for (std::size_t g = 0; g < count; ++g) at[g] = drawn.positions[glued.first[g]];
  for (int round = 0; round <= kRounds; ++round) {
    for (std::size_t g = 0; g < count; ++g) {
      const std::size_t v = glued.first[g];
      found[g] = target.nearest(at[g], drawn.normals[v], fingers[v], found[g].triangle);
      steps[g] = target.place(found[g]) - at[g];
      if (glm::length(steps[g]) > kFarthest_m || behind_m[v] > cap_m) steps[g] = glm::vec3(0);
    }
    smooth(glued, steps, kSmoothest * (kRounds - round) / kRounds);
    for (std::size_t g = 0; g < count; ++g) at[g] += steps[g];
  }
  std::vector<SurfacePoint> map;
  for (const std::size_t g : glued.of_vertex) map.push_back(found[g]);
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
