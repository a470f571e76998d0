// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace handcast::twin {

/// A cross-section of a limb: half an ellipse towards the back of the hand, half of another towards
/// the palm.
struct Section {
  double along_mm = 0;       ///< its place on the axis
  double half_width_mm = 0;  ///< to the thumb's side, and to the other one
  double back_mm = 0;        ///< from the axis to the back
  double palm_mm = 0;        ///< from the axis to the palm
};

/// Flesh about a straight axis: cross-sections with smooth transitions and two rounded ends.
class Limb {
 public:
  /// The axis begins at `origin`. `axes`: columns to the thumb, out of the back, and against the
  /// direction of the axis. `sections` are in ascending order; a single one makes an ellipsoid. The
  /// ends are `begin_mm` and `end_mm` long, beyond the first and the last section.
  Limb(const glm::dvec3& origin, const glm::dmat3& axes, std::vector<Section> sections,
       double begin_mm, double end_mm);

  /// About the distance to the skin, which is exact to first order there; negative inside.
  double distance_mm(const glm::dvec3& point) const;
  /// The place of a point along the axis.
  double along_mm(const glm::dvec3& point) const;

 private:
  Section section_at(double along_mm) const;

  glm::dvec3 origin_;
  glm::dmat3 axes_;
  std::vector<Section> sections_;
  double begin_mm_, end_mm_;
};

}  // namespace handcast::twin
