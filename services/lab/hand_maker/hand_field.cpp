// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/hand_field.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

/// Widths of the smooth unions, in tuned millimetres.
constexpr double kInsideFinger = 4.5, kFingerToFinger = 1.2, kInsidePalm = 14, kBallToPalm = 22,
                 kPalmToFingers = 10;
/// Increase of the palm by its smooth unions, in tuned millimetres.
constexpr double kPalmSwelling = 2.0;

Reading union_of(const Cones& cones, const glm::dvec3& point, double width) {
  Reading all = cones.front().at(point);
  for (std::size_t k = 1; k < cones.size(); ++k) all = smooth_union(all, cones[k].at(point), width);
  return all;
}

}  // namespace

HandField::HandField(const HandShape& shape, const RestPose& rest)
    : palm_(palm_cones(shape, rest)),
      thumb_ball_(thumb_ball_cones(shape, rest)),
      scale_(flesh_scale(shape)) {
  for (int f = 0; f < kFingers; ++f) fingers_[f] = finger_cones(shape, rest, f);
}

Reading HandField::at(const glm::dvec3& point) const {
  Reading fingers = union_of(fingers_[0], point, kInsideFinger * scale_);
  for (int f = 1; f < kFingers; ++f)
    fingers = smooth_union(fingers, union_of(fingers_[f], point, kInsideFinger * scale_),
                           kFingerToFinger * scale_);
  Reading palm =
      smooth_union(union_of(palm_, point, kInsidePalm * scale_),
                   union_of(thumb_ball_, point, kInsidePalm * scale_), kBallToPalm * scale_);
  palm.distance_mm += kPalmSwelling * scale_;
  return smooth_union(fingers, palm, kPalmToFingers * scale_);
}

glm::dvec3 HandField::normal(const glm::dvec3& point) const {
  const glm::dvec3 gradient = at(point).gradient;
  return gradient / (glm::length(gradient) + 1e-12);
}

glm::dvec3 HandField::projected(glm::dvec3 point, int steps) const {
  constexpr double kLongestStep = 6;
  for (int k = 0; k < steps; ++k) {
    const Reading here = at(point);
    // The gradient is small between cones; the limit prevents large steps there.
    const double slope_squared = std::max(glm::dot(here.gradient, here.gradient), 0.25);
    point -=
        here.gradient * std::clamp(here.distance_mm / slope_squared, -kLongestStep, kLongestStep);
  }
  return point;
}

}  // namespace handcast::renderer
