// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "services/lab/hand_maker/rest_pose.hpp"

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

/// Shapes whose union is a part of the hand.
using Cones = std::vector<RoundCone>;

/// The flesh of one finger: for each phalanx two cones side by side (wider than deep), and a pad
/// and a knuckle, or the pulp of the tip.
Cones finger_cones(const HandShape& shape, const RestPose& rest, int finger);
/// The metacarpals and the flesh between them, knuckles, webs, pads, hypothenar, wrist and forearm.
Cones palm_cones(const HandShape& shape, const RestPose& rest);
/// The thumb's metacarpal, its ball (thenar) and its web to the index finger.
Cones thumb_ball_cones(const HandShape& shape, const RestPose& rest);

/// Millimetres per tuned millimetre. The measures of the flesh were tuned on a palm with a half
/// thickness of 12 mm and scale with it.
inline double flesh_scale(const HandShape& shape) { return shape.palm_half_thickness_mm / 12.0; }

/// A smooth distance field whose zero is the skin of a left hand at rest. Millimetres.
class HandField {
 public:
  /// Builds the field of `shape`, whose rest pose must be `rest`.
  HandField(const HandShape& shape, const RestPose& rest);

  /// The field at a point. Away from the skin the distance is approximate.
  Reading at(const glm::dvec3& point) const;
  /// The unit normal of the field at a point, away from the hand.
  glm::dvec3 normal(const glm::dvec3& point) const;
  /// Moves a point to the skin by Newton steps along the gradient, each at most 6 mm.
  glm::dvec3 projected(glm::dvec3 point, int steps) const;

 private:
  std::array<Cones, kFingers> fingers_;
  Cones palm_, thumb_ball_;
  double scale_;
};

}  // namespace handcast::renderer
