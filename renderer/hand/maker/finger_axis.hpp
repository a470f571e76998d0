// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "renderer/hand/maker/rest_pose.hpp"

namespace handcast::renderer {

/// The bent line through a finger's joints, from the MCP joint (thumb: the CMC) to the tip, with
/// axes that turn smoothly.
class FingerAxis {
 public:
  FingerAxis(const RestPose& rest, int finger);

  double length_mm() const { return arc_mm_[kBones]; }
  /// Arc length of the k-th joint, 0..3.
  double joint_mm(int k) const { return arc_mm_[k]; }
  glm::dvec3 point(double arc_mm) const;
  glm::dmat3 axes(double arc_mm) const;
  /// The finger's radius there, between those of its joints.
  double radius_mm(const HandShape& shape, double arc_mm) const;

 private:
  static constexpr int kBones = 3;
  std::size_t bone_at(double arc_mm) const;

  int finger_;
  std::array<glm::dvec3, kBones + 1> joint_;
  std::array<glm::dmat3, kBones> axes_;
  std::array<double, kBones + 1> arc_mm_{};
};

}  // namespace handcast::renderer
