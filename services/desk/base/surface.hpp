// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::desk {

/// What one hand does.
struct Gesture {
  bool is_there = false;       ///< the tracker sees it, for longer than a moment
  float pinch = 0;             ///< thumb and index finger: 0 apart, 1 touching
  float spread = 0;            ///< fingers: 0 together, 1 apart
  float fist = 0;              ///< 0 open, 1 closed
  float palm_up = 0;           ///< cosine between the palm's normal and up, -1..1
  float speed_m_s = 0;         ///< of the palm
  bool is_pointing = false;    ///< with the index finger alone
  bool touches_other = false;  ///< the other hand
  double absent_s = 0;         ///< how long it has not been there
};

/// The hands as the desk sees them at one time.
struct Scene {
  std::int64_t now_ns = 0;                         ///< CLOCK_MONOTONIC
  msg::HandPoses poses;                            ///< the newest; none: count == 0
  std::array<Gesture, msg::kMaxHands> gestures{};  ///< left, right
  /// The joints in the camera's space, m, and their places in the hand's texture, 0..1, by
  /// msg::Side; only of hands that are there.
  /// @{
  std::array<std::array<glm::vec3, msg::kJoints>, msg::kMaxHands> joints_m{};
  std::array<std::array<glm::vec2, msg::kJoints>, msg::kMaxHands> joints_uv{};
  /// @}
  std::vector<std::string> events;  ///< since the last turn: "left.appears", "right.pinch", "idle"
};

/// Something that a person works the rig with, or that tells others about it. A surface may have
/// threads of its own for what comes in.
class Surface {
 public:
  virtual ~Surface() = default;
  /// Called 60 times a second by the desk's main thread; never blocks.
  virtual void turn(const Scene& scene) = 0;
};

}  // namespace handcast::desk
