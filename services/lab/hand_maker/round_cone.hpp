// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::renderer {

/// The value of a distance field at a point.
struct Reading {
  double distance_mm = 0;  ///< negative inside the shape
  glm::dvec3 gradient{0};  ///< of the distance: points away from the shape
};

/// The convex hull of two spheres.
class RoundCone {
 public:
  /// The centres and radii of the spheres, in mm.
  RoundCone(const glm::dvec3& from, const glm::dvec3& to, double radius_from, double radius_to);
  /// The exact distance field at a point.
  Reading at(const glm::dvec3& point) const;

 private:
  glm::dvec3 from_, to_, axis_;
  double radius_from_, radius_to_, length_;
  double sin_ = 0, cos_ = 1;  ///< of the angle between the axis and the side
};

/// Union of two shapes that rounds the crease between them over `width` mm: with h = 1 - |a - b| /
/// width, the smaller distance is reduced by h^2 width / 4 and the gradients are blended by h / 2
/// if h is positive.
Reading smooth_union(const Reading& a, const Reading& b, double width);

}  // namespace handcast::renderer
