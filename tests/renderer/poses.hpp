// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <string_view>

#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer::samples {

/// Rotations of the joints from rest, in degrees. Fingers: abduction (towards the thumb), then
/// flexion of MCP, PIP and DIP. Thumb: rotation of the CMC about its dorsal axis (towards the edge
/// of the palm), its flexion, its twist; flexion of MCP and IP.
struct Pose {
  std::string_view name;
  std::array<float, 5> thumb{};
  std::array<std::array<float, 4>, 4> fingers{};
};

inline constexpr Pose kOpen{"open"};
inline constexpr Pose kFist{
    "fist",
    {6, 3, -11, 20, 69},
    {{{-5, 78, 92, 52}, {-1, 82, 95, 55}, {3, 82, 95, 55}, {9, 80, 92, 52}}}};
inline constexpr Pose kPoint{"point",
                             {6, 3, -11, 20, 69},
                             {{{-4, 0, 0, 0}, {-1, 82, 95, 55}, {3, 82, 95, 55}, {9, 80, 92, 52}}}};
inline constexpr Pose kPinch{
    "pinch",
    {31, 7, 15, 0, 0},
    {{{-10, 20, 68, 40}, {-4, 34, 42, 26}, {-2, 30, 36, 20}, {0, 24, 26, 14}}}};
inline constexpr Pose kOk{
    "ok", {31, 7, 15, 0, 0}, {{{-10, 20, 68, 40}, {1, 10, 8, 4}, {0, 4, 6, 4}, {-4, 2, 4, 2}}}};
inline constexpr std::array<Pose, 5> kPoses{kOpen, kFist, kPinch, kOk, kPoint};

inline glm::mat4 turn(float degrees, const glm::vec3& axis) {
  return glm::rotate(glm::mat4(1), glm::radians(degrees), axis);
}

/// The joints of a hand in a pose, with the wrist at rest. Rotations are given for a left hand and
/// mirrored for a right one.
inline JointFrames posed(const HandMesh& hand, const Pose& pose) {
  const float mirror = hand.side == Side::left ? 1.0f : -1.0f;
  const glm::vec3 x(1, 0, 0), y(0, mirror, 0), z(0, 0, mirror);
  std::array<glm::mat4, kJoints> local;
  local.fill(glm::mat4(1));
  const auto& t = pose.thumb;
  local[2] = turn(t[0], y) * turn(-t[1], x) * turn(t[2], z);
  local[3] = turn(-t[3], x);
  local[4] = turn(-t[4], x);
  for (int f = 0; f < 4; ++f) {
    const auto& [spread, mcp, pip, dip] = pose.fingers[f];
    const int proximal = 7 + 5 * f;
    local[proximal] = turn(-spread, y) * turn(-mcp, x);
    local[proximal + 1] = turn(-pip, x);
    local[proximal + 2] = turn(-dip, x);
  }
  JointFrames frames;
  frames[1] = hand.rest[1];
  for (const int first : {0, 2, 6, 11, 16, 21})
    for (int j = first; j < (first == 0 ? 1 : first == 2 ? 6 : first + 5); ++j) {
      const int parent = kJointParent[j];
      frames[j] = frames[parent] * glm::inverse(hand.rest[parent]) * hand.rest[j] * local[j];
    }
  return frames;
}

}  // namespace handcast::renderer::samples
