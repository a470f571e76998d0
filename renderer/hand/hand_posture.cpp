// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/hand_posture.hpp"

#include <numeric>

namespace handcast::renderer {
namespace {

constexpr int kWristJoint = 1, kThumbTip = 5, kIndexTip = 10;
constexpr std::array<int, 4> kKnuckles{7, 12, 17, 22};  ///< index to little finger
constexpr int kFromKnuckleToPip = 1, kFromKnuckleToTip = 3;

/// The length of the way from the wrist to a fingertip along its joints, the metacarpal left out.
float way_m(JointPlaces joints, int knuckle) {
  float way = glm::distance(joints[kWristJoint], joints[knuckle]);
  for (int joint = knuckle; joint < knuckle + kFromKnuckleToTip; ++joint)
    way += glm::distance(joints[joint], joints[joint + 1]);
  return way;
}

float ratio(float part, float whole) { return whole > 1e-4f ? part / whole : 0; }

float spread_of(JointPlaces joints) {
  const auto across = [&](int from_knuckle) {
    return glm::distance(joints[kKnuckles.front() + from_knuckle],
                         joints[kKnuckles.back() + from_knuckle]);
  };
  return glm::smoothstep(1.05f, 1.5f, ratio(across(kFromKnuckleToPip), across(0)));
}

float pinch_of(JointPlaces joints) {
  const float size_m = glm::distance(joints[kWristJoint], joints[kKnuckles[1]]);
  const float apart_m = glm::distance(joints[kThumbTip], joints[kIndexTip]);
  return 1 - glm::smoothstep(0.2f, 0.65f, ratio(apart_m, size_m));
}

}  // namespace

HandPosture posture_of(JointPlaces joints) {
  HandPosture posture{.pinch = pinch_of(joints), .spread = spread_of(joints)};
  for (std::size_t finger = 0; finger < kKnuckles.size(); ++finger) {
    const int knuckle = kKnuckles[finger];
    posture.reach[finger] =
        ratio(glm::distance(joints[kWristJoint], joints[knuckle + kFromKnuckleToTip]),
              way_m(joints, knuckle));
  }
  const float reach = 0.25f * std::accumulate(posture.reach.begin(), posture.reach.end(), 0.f);
  posture.curl = 1 - glm::smoothstep(0.45f, 0.95f, reach);
  return posture;
}

glm::mat3 palm_axes(JointPlaces joints, msg::Side side) {
  glm::vec3 middle(0);
  for (const int knuckle : kKnuckles) middle += 0.25f * joints[knuckle];
  glm::vec3 to_thumb = joints[kKnuckles.front()] - joints[kKnuckles.back()];
  const glm::vec3 to_arm = joints[kWristJoint] - middle;
  if (side == msg::Side::right) to_thumb = -to_thumb;
  const glm::vec3 back = glm::cross(to_arm, to_thumb);
  const float area = glm::length(back), length = glm::length(to_arm);
  if (area < 1e-8f || length < 1e-4f) return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  const glm::vec3 y = back / area, z = to_arm / length;
  return {glm::cross(y, z), y, z};
}

}  // namespace handcast::renderer
