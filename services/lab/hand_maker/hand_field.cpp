// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/hand_field.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::renderer {
namespace {

Reading sphere(const glm::dvec3& from_centre, double radius) {
  const double distance = glm::length(from_centre) + 1e-12;
  return {distance - radius, from_centre / distance};
}

}  // namespace

RoundCone::RoundCone(const glm::dvec3& from, const glm::dvec3& to, double radius_from,
                     double radius_to)
    : from_(from),
      to_(to),
      radius_from_(radius_from),
      radius_to_(radius_to),
      length_(glm::distance(from, to)) {
  if (length_ <= std::abs(radius_from - radius_to)) {  // one sphere contains the other
    if (radius_to > radius_from) from_ = to_, radius_from_ = radius_to_;
    length_ = 0;
    return;
  }
  axis_ = (to - from) / length_;
  sin_ = (radius_from - radius_to) / length_;
  cos_ = std::sqrt(1 - sin_ * sin_);
}

Reading RoundCone::at(const glm::dvec3& point) const {
  const glm::dvec3 from_start = point - from_;
  if (length_ == 0) return sphere(from_start, radius_from_);
  const double along = glm::dot(from_start, axis_);
  const glm::dvec3 off_axis = from_start - axis_ * along;
  const double away = glm::length(off_axis);
  // The point at which the normal of the slanted side meets the axis.
  const double foot = along - away * sin_ / cos_;
  if (foot <= 0) return sphere(from_start, radius_from_);
  if (foot >= length_) return sphere(point - to_, radius_to_);
  return {away * cos_ + along * sin_ - radius_from_,
          off_axis * (cos_ / (away + 1e-12)) + axis_ * sin_};
}

Reading smooth_union(const Reading& a, const Reading& b, double width) {
  const bool a_is_nearer = a.distance_mm < b.distance_mm;
  const Reading &near = a_is_nearer ? a : b, &far = a_is_nearer ? b : a;
  const double gap = far.distance_mm - near.distance_mm;
  if (gap >= width) return near;
  const double h = 1 - gap / width;
  return {near.distance_mm - h * h * width * 0.25,
          near.gradient * (1 - 0.5 * h) + far.gradient * (0.5 * h)};
}

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
