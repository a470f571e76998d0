// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::pose {

/// By how much two sources differ about one hand: a displacement and a rotation of each joint, in
/// tracker space. A value.
class JointOffsets {
 public:
  /// What must be applied to `from` to get `to`.
  static JointOffsets between(const msg::HandPose& from, const msg::HandPose& to);

  /// `pose` with `share` (0..1) of the offsets.
  msg::HandPose applied(const msg::HandPose& pose, float share) const;
  /// Moves by `share` (0..1) towards other offsets.
  void approach(const JointOffsets& other, float share);
  /// The offsets the other way round.
  JointOffsets reversed() const;
  /// The largest and the mean distance to the displacements of other offsets.
  /// @{
  float farthest_m(const JointOffsets& other) const;
  float mean_m(const JointOffsets& other) const;
  /// @}

 private:
  std::array<glm::vec3, msg::kJoints> moved_m_{};
  std::array<glm::quat, msg::kJoints> turned_{};  ///< w >= 0
};

}  // namespace handcast::pose
