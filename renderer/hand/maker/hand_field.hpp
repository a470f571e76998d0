// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "renderer/hand/maker/rest_pose.hpp"
#include "renderer/hand/maker/round_cone.hpp"

namespace handcast::renderer {

using Cones = std::vector<RoundCone>;

/// The flesh of one finger: per phalanx two cones side by side (broader than deep), a pad, and a
/// knuckle or finger pulp.
Cones finger_cones(const HandShape& shape, const RestPose& rest, int finger);
/// Metacarpals and the flesh between, knuckles, webs, pads, hypothenar, wrist and forearm.
Cones palm_cones(const HandShape& shape, const RestPose& rest);
/// The thumb's metacarpal, its ball (thenar) and its web to the index.
Cones thumb_ball_cones(const HandShape& shape, const RestPose& rest);

/// Millimetres per tuned millimetre: the measures of flesh were found on a palm half 12 mm thick
/// and grow with it.
inline double flesh_scale(const HandShape& shape) { return shape.palm_half_thickness_mm / 12.0; }

/// The skin of a left hand at rest as the zero of a smooth distance field (millimetres).
class HandField {
 public:
  HandField(const HandShape& shape, const RestPose& rest);

  Reading at(const glm::dvec3& point) const;
  /// The unit normal of the field there.
  glm::dvec3 normal(const glm::dvec3& point) const;
  /// Newton steps towards the skin along the gradient, each at most 6 mm.
  glm::dvec3 projected(glm::dvec3 point, int steps) const;

 private:
  std::array<Cones, kFingers> fingers_;
  Cones palm_, thumb_ball_;
  double scale_;
};

}  // namespace handcast::renderer
