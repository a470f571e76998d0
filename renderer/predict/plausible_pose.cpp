// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/plausible_pose.hpp"

#include <algorithm>

#include "renderer/base/joint_math.hpp"

namespace handcast::renderer {
namespace {

constexpr float kFarthestWrist_m = 3, kFarthestJoint_m = 0.8f;
constexpr int kWrist = 1;

}  // namespace

// Written so that a comparison with NaN refuses.
bool is_plausible(const msg::HandPose& pose, const glm::dmat4& camera_from_tracker) {
  const glm::vec3 wrist = position(pose.joints[kWrist]);
  if (!(glm::length(glm::dvec3(camera_from_tracker * glm::dvec4(wrist, 1))) < kFarthestWrist_m))
    return false;
  return std::ranges::all_of(pose.joints, [&](const msg::Joint& joint) {
    const auto& [x, y, z, w] = joint.orientation_xyzw;
    const float norm2 = x * x + y * y + z * z + w * w;
    return glm::length(position(joint) - wrist) < kFarthestJoint_m && norm2 > 0.5f && norm2 < 2;
  });
}

}  // namespace handcast::renderer
