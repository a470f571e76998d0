// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// The message of a tracker that sees `joints`, moved by `moved_m`.
inline msg::HandPose pose_of(Side side, const JointFrames& joints, glm::vec3 moved_m = {}) {
  msg::HandPose pose;
  pose.side = side;
  pose.confidence = 1;
  for (int j = 0; j < kJoints; ++j) {
    const glm::quat turn = glm::quat_cast(glm::mat3(joints[j]));
    const glm::vec3 at = glm::vec3(joints[j][3]) + moved_m;
    pose.joints[j] = {{at.x, at.y, at.z}, {turn.x, turn.y, turn.z, turn.w}, 0.01f};
  }
  return pose;
}

}  // namespace handcast::renderer
