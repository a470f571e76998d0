// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/bystander.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace handcast::twin {

renderer::JointFrames bystander_joints(const renderer::HandMesh& hand,
                                       const calib::CameraModel& camera) {
  constexpr float kDistance_m = 0.85f;
  const glm::dvec2 wrist_px(0.97 * camera.width_px, 0.30 * camera.height_px);
  const glm::vec3 wrist((wrist_px.x - camera.cx_px) / camera.fx_px * kDistance_m,
                        (wrist_px.y - camera.cy_px) / camera.fy_px * kDistance_m, kDistance_m);
  // A hand's axes: x to the right, y out of the back, -z to the tips. The back faces the camera and
  // the fingers point to the left and a little down.
  const glm::vec3 fingers = glm::normalize(glm::vec3(-1, 0.25f, 0)), back(0, 0, -1);
  glm::mat4 camera_from_wrist(1);
  camera_from_wrist[0] = glm::vec4(glm::cross(back, -fingers), 0);
  camera_from_wrist[1] = glm::vec4(back, 0);
  camera_from_wrist[2] = glm::vec4(-fingers, 0);
  camera_from_wrist[3] = glm::vec4(wrist, 1);
  const glm::mat4 camera_from_model = camera_from_wrist * glm::inverse(hand.rest[1]);
  renderer::JointFrames joints;
  for (int j = 0; j < msg::kJoints; ++j) joints[j] = camera_from_model * hand.rest[j];
  return joints;
}

}  // namespace handcast::twin
