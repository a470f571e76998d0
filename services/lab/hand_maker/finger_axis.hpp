// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "services/lab/hand_maker/rest_pose.hpp"

namespace handcast::renderer {

/// The polyline through a finger's joints, from the MCP joint (thumb: the CMC joint) to the tip,
/// with axes that turn smoothly. Positions on it are given by their arc length from its start.
class FingerAxis {
 public:
  /// Copies the joints of one finger.
  FingerAxis(const RestPose& rest, int finger);

  /// Arc length of the tip.
  double length_mm() const { return arc_mm_[kBones]; }
  /// Arc length of joint `k`, 0..3.
  double joint_mm(int k) const { return arc_mm_[k]; }
  /// The point at an arc length, which is clamped to the ends.
  glm::dvec3 point(double arc_mm) const;
  /// The axes at an arc length. Columns as in RestPose.
  glm::dmat3 axes(double arc_mm) const;
  /// The radius of the finger at an arc length, interpolated between its joints.
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
