// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::renderer {

/// What a distance field says of a point: negative inside; the gradient points away from the shape.
struct Reading {
  double distance_mm = 0;
  glm::dvec3 gradient{0};
};

/// The hull of two spheres.
class RoundCone {
 public:
  RoundCone(const glm::dvec3& from, const glm::dvec3& to, double radius_from, double radius_to);
  Reading at(const glm::dvec3& point) const;

 private:
  glm::dvec3 from_, to_, axis_;
  double radius_from_, radius_to_, length_;
  double sin_ = 0, cos_ = 1;  ///< of the angle between the axis and the side
};

/// Union that rounds the crease between two shapes over `width` (quadratic polynomial: a, b and
/// their gradients mixed by h = 1 - |a - b| / width where that is positive).
Reading smooth_union(const Reading& a, const Reading& b, double width);

}  // namespace handcast::renderer
