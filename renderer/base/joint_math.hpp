// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/msg/hand_poses.hpp"

/// Places and turns of joints. Functions without state.
namespace handcast::renderer {

/// The joints that fingers do not move: palm, wrist, and both ends of the metacarpals.
inline constexpr std::array kPalmJoints{0, 1, 6, 7, 11, 12, 16, 17, 21, 22};
/// A rotation counts as the movement of skin at this distance from the joint.
inline constexpr float kTurnLever_m = 0.05f;

/// The position in m.
glm::vec3 position(const msg::Joint& joint);
/// The orientation, a unit quaternion.
glm::quat orientation(const msg::Joint& joint);
/// Sets the position and the orientation.
void place(msg::Joint& joint, const glm::vec3& at, const glm::quat& turned);

/// `q` or -q, which is the same rotation: the one nearer to `reference`.
glm::quat on_side_of(const glm::quat& reference, const glm::quat& q);
/// From `a` (t = 0) to `b` (t = 1).
glm::quat blend(const glm::quat& a, const glm::quat& b, float t);
/// Angle between `a` and `b`, radians.
float angle_between(const glm::quat& a, const glm::quat& b);
/// `newest` rotated further by `share` times the rotation from `earlier` to `newest`, by one radian
/// at most.
glm::quat turned_on(const glm::quat& earlier, const glm::quat& newest, float share);

}  // namespace handcast::renderer
