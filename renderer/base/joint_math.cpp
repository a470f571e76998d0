// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/joint_math.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::renderer {
namespace {

constexpr float kMostTurn_rad = 1.0f;

}  // namespace

glm::vec3 position(const msg::Joint& joint) {
  return {joint.position_m[0], joint.position_m[1], joint.position_m[2]};
}

glm::quat orientation(const msg::Joint& joint) {
  const auto& [x, y, z, w] = joint.orientation_xyzw;
  return {w, x, y, z};
}

void place(msg::Joint& joint, const glm::vec3& at, const glm::quat& turned) {
  joint.position_m = {at.x, at.y, at.z};
  joint.orientation_xyzw = {turned.x, turned.y, turned.z, turned.w};
}

glm::quat on_side_of(const glm::quat& reference, const glm::quat& q) {
  return glm::dot(reference, q) < 0 ? -q : q;
}

glm::quat blend(const glm::quat& a, const glm::quat& b, float t) {
  return glm::normalize(a * (1 - t) + on_side_of(a, b) * t);
}

/// From the chord: the arc cosine is inaccurate for small angles.
float angle_between(const glm::quat& a, const glm::quat& b) {
  const glm::quat chord = on_side_of(a, b) - a;
  return 4 * std::asin(std::min(1.0f, 0.5f * glm::length(chord)));
}

glm::quat turned_on(const glm::quat& earlier, const glm::quat& newest, float share) {
  const glm::quat turn = on_side_of({1, 0, 0, 0}, newest * glm::conjugate(earlier));
  const glm::vec3 sine_axis{turn.x, turn.y, turn.z};
  const float sine = glm::length(sine_axis);
  if (sine < 1e-7f) return newest;
  const float angle =
      std::clamp(2 * std::atan2(sine, turn.w) * share, -kMostTurn_rad, kMostTurn_rad);
  return glm::normalize(glm::angleAxis(angle, sine_axis / sine) * newest);
}

}  // namespace handcast::renderer
