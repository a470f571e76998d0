// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/finger_axis.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::renderer {

FingerAxis::FingerAxis(const RestPose& rest, int finger) : finger_(finger) {
  const int first = tip_of(finger) - kBones;
  for (int k = 0; k <= kBones; ++k) joint_[k] = rest.position_mm[first + k];
  for (int k = 0; k < kBones; ++k) {
    axes_[k] = rest.axes[first + k];
    arc_mm_[k + 1] = arc_mm_[k] + glm::distance(joint_[k], joint_[k + 1]);
  }
}

std::size_t FingerAxis::bone_at(double arc_mm) const {
  std::size_t bone = 0;
  while (bone + 1 < kBones && arc_mm >= arc_mm_[bone + 1]) ++bone;
  return bone;
}

glm::dvec3 FingerAxis::point(double arc_mm) const {
  const std::size_t k = bone_at(arc_mm);
  const double share =
      (std::clamp(arc_mm, 0.0, length_mm()) - arc_mm_[k]) / (arc_mm_[k + 1] - arc_mm_[k]);
  return glm::mix(joint_[k], joint_[k + 1], share);
}

glm::dmat3 FingerAxis::axes(double arc_mm) const {
  constexpr double kReach = 5;  // mm: decay of a bone's weight beyond its ends
  glm::dmat3 sum(0);
  for (int k = 0; k < kBones; ++k) {
    const double beyond = std::max({0.0, arc_mm_[k] - arc_mm, arc_mm - arc_mm_[k + 1]}) / kReach;
    sum += axes_[k] * std::exp(-beyond * beyond);
  }
  const glm::dvec3 proximal = glm::normalize(sum[2]);
  const glm::dvec3 lateral = glm::normalize(sum[0] - proximal * glm::dot(sum[0], proximal));
  return {lateral, glm::cross(proximal, lateral), proximal};
}

double FingerAxis::radius_mm(const HandShape& shape, double arc_mm) const {
  const std::size_t k = bone_at(arc_mm);
  const double share = std::clamp((arc_mm - arc_mm_[k]) / (arc_mm_[k + 1] - arc_mm_[k]), 0.0, 1.0);
  return std::lerp(double(shape.radius_mm[finger_][k]), double(shape.radius_mm[finger_][k + 1]),
                   share);
}

}  // namespace handcast::renderer
