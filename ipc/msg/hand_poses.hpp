// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "ipc/msg/header.hpp"

namespace handcast::msg {

inline constexpr int kJoints = 26;   ///< XR_EXT_hand_tracking, in its order
inline constexpr int kMaxHands = 2;  ///< per rig

enum class Side : std::uint32_t { left = 0, right = 1 };

/// One joint in tracker space. Axes as in OpenXR: +x right, +y out of the back of the hand, -z
/// towards the finger tip.
struct Joint {
  std::array<float, 3> position_m{};
  std::array<float, 4> orientation_xyzw{0, 0, 0, 1};
  float radius_m = 0;  ///< from the joint to the skin
};

struct HandPose {
  Side side = Side::left;
  float confidence = 0;  ///< 0..1
  std::array<Joint, kJoints> joints{};
};

/// Every hand one tracker sample saw.
/// Published by: services/pose ("pose.hands", with history).  Read by: services/projector.
struct HandPoses {
  static constexpr std::string_view layout = "HandPoses/1";

  Header header;  ///< origin: the sensor's sample time
  std::uint32_t count = 0;
  std::uint32_t reserved = 0;
  std::array<HandPose, kMaxHands> hands{};  ///< the first `count` are valid

  const HandPose* find(Side side) const {
    for (std::uint32_t i = 0; i < count && i < hands.size(); ++i)
      if (hands[i].side == side) return &hands[i];
    return nullptr;
  }
};

}  // namespace handcast::msg
