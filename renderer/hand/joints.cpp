// SPDX-License-Identifier: Apache-2.0
#include <glm/gtc/quaternion.hpp>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

const std::array<std::string_view, kJoints> kJointNames{
    "palm",
    "wrist",
    "thumb-metacarpal",
    "thumb-phalanx-proximal",
    "thumb-phalanx-distal",
    "thumb-tip",
    "index-finger-metacarpal",
    "index-finger-phalanx-proximal",
    "index-finger-phalanx-intermediate",
    "index-finger-phalanx-distal",
    "index-finger-tip",
    "middle-finger-metacarpal",
    "middle-finger-phalanx-proximal",
    "middle-finger-phalanx-intermediate",
    "middle-finger-phalanx-distal",
    "middle-finger-tip",
    "ring-finger-metacarpal",
    "ring-finger-phalanx-proximal",
    "ring-finger-phalanx-intermediate",
    "ring-finger-phalanx-distal",
    "ring-finger-tip",
    "pinky-finger-metacarpal",
    "pinky-finger-phalanx-proximal",
    "pinky-finger-phalanx-intermediate",
    "pinky-finger-phalanx-distal",
    "pinky-finger-tip",
};

const std::array<int, kJoints> kJointParent{
    1, -1,              // palm, wrist
    1, 2,  3,  4,       // thumb
    1, 6,  7,  8,  9,   // index
    1, 11, 12, 13, 14,  // middle
    1, 16, 17, 18, 19,  // ring
    1, 21, 22, 23, 24,  // little
};

JointFrames frames_of(const msg::HandPose& pose) {
  JointFrames frames;
  for (int j = 0; j < kJoints; ++j) {
    const auto& [position, q, radius] = pose.joints[j];
    frames[j] = glm::mat4_cast(glm::normalize(glm::quat(q[3], q[0], q[1], q[2])));
    frames[j][3] = {position[0], position[1], position[2], 1};
  }
  return frames;
}

}  // namespace handcast::renderer
