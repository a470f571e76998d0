// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/glove_fit.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

/// Sphere tracing: finds the first point of the skin from `start` along `direction`. Returns false
/// if there is none within `reach` mm.
bool meet_skin(const HandField& field, const glm::dvec3& start, const glm::dvec3& direction,
               double reach, glm::dvec3& met) {
  double way = 0;
  for (int k = 0; k < 60 && way < reach; ++k) {
    const double distance = field.at(start + direction * way).distance_mm;
    if (distance < 0.05) {
      met = start + direction * way;
      return true;
    }
    way += std::max(distance * 0.9, 0.1);
  }
  return false;
}

glm::dvec3 first_place(const GloveTemplate& glove, const GloveLayout& layout,
                       const HandField& field, int glued) {
  constexpr double kOutside = 45, kReach = 60;
  const int v = glove.sheet_of_glued(glued);
  if (glove.on_seam(v)) return layout.middle[v];
  const glm::dvec3 outward = layout.dorsal[v] * (glove.on_back(glued) ? 1.0 : -1.0);
  glm::dvec3 met;
  const bool in_palm = glove.sheet()[v].finger < 0;
  if (in_palm && meet_skin(field, layout.middle[v] + outward * kOutside, -outward, kReach, met))
    return met;
  return layout.middle[v] + outward * layout.half_thickness[v];
}

/// The neighbours of each vertex.
struct Neighbours {
  std::vector<std::vector<int>> of;
  Neighbours(int count, const std::vector<Edge>& edges) : of(count) {
    for (const auto& [a, b] : edges) {
      of[a].push_back(b);
      of[b].push_back(a);
    }
  }
  glm::dvec3 to_mean(const SkinPoints& points, int v) const {
    glm::dvec3 sum(0);
    for (const int n : of[v]) sum += points[n];
    return sum / double(of[v].size()) - points[v];
  }
};

}  // namespace

SkinPoints place_on_skin(const GloveTemplate& glove, const GloveLayout& layout,
                         const HandField& field) {
  SkinPoints points;
  for (int v = 0; v < glove.glued_count(); ++v)
    points.push_back(field.projected(first_place(glove, layout, field, v), 8));
  return points;
}

void relax_on_skin(SkinPoints& points, const GloveTemplate& glove, const GloveLayout& layout,
                   const HandField& field, int rounds) {
  constexpr double kFingerPace = 0.25, kPalmPace = 0.8, kSeamPace = 0.5, kSilhouettePull = 0.9;
  const Neighbours all(glove.glued_count(), glove.glued_edges()),
      seam(glove.glued_count(), glove.seam_edges());
  SkinPoints next(points.size());
  for (int round = 0; round < rounds; ++round) {
    const double pull = kSilhouettePull * (1 - double(round) / rounds);
    for (int v = 0; v < glove.glued_count(); ++v) {
      const int on_sheet = glove.sheet_of_glued(v);
      const glm::dvec3 normal = field.normal(points[v]);
      const auto along_skin = [&](const glm::dvec3& step) {
        return step - normal * glm::dot(step, normal);
      };
      glm::dvec3 step;
      if (glove.on_seam(on_sheet)) {
        const glm::dvec3& dorsal = layout.dorsal[on_sheet];
        step = along_skin(seam.to_mean(points, v)) * kSeamPace -
               along_skin(dorsal) * (pull * glm::dot(normal, dorsal));
      } else {
        step = along_skin(all.to_mean(points, v)) *
               (glove.sheet()[on_sheet].finger >= 0 ? kFingerPace : kPalmPace);
      }
      next[v] = field.projected(points[v] + step, 1);
    }
    points.swap(next);
  }
  for (glm::dvec3& point : points) point = field.projected(point, 3);
}

SkinPoints settled_on_skin(const SkinPoints& carried, const GloveTemplate& glove,
                           const HandField& field, int rounds) {
  constexpr double kPace = 0.7;
  const Neighbours neighbours(glove.glued_count(), glove.glued_edges());
  SkinPoints points, moved(carried.size()), next(carried.size());
  for (const glm::dvec3& point : carried) points.push_back(field.projected(point, 4));
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t v = 0; v < points.size(); ++v) moved[v] = points[v] - carried[v];
    for (int v = 0; v < glove.glued_count(); ++v) {
      const glm::dvec3 normal = field.normal(points[v]), step = neighbours.to_mean(moved, v);
      next[v] = field.projected(points[v] + (step - normal * glm::dot(step, normal)) * kPace, 1);
    }
    points.swap(next);
  }
  for (glm::dvec3& point : points) point = field.projected(point, 3);
  return points;
}

}  // namespace handcast::renderer
