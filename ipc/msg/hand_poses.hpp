// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "ipc/msg/header.hpp"

namespace handcast::msg {

inline constexpr int kJoints = 26;   ///< the joints of XR_EXT_hand_tracking, in its order
inline constexpr int kMaxHands = 2;  ///< hands of one rig

/// The person's left or right hand.
enum class Side : std::uint32_t { left = 0, right = 1 };

/// One joint in tracker space. Axes of its orientation as in OpenXR: +x right, +y out of the back
/// of the hand, -z towards the finger tip.
struct Joint {
  std::array<float, 3> position_m{};                  ///< x, y, z in tracker space
  std::array<float, 4> orientation_xyzw{0, 0, 0, 1};  ///< quaternion: tracker from joint
  float radius_m = 0;                                 ///< distance from the joint to the skin
};

/// One hand in one tracker sample.
struct HandPose {
  Side side = Side::left;               ///< as reported by the tracker
  float confidence = 0;                 ///< 0..1; below 0.1 the hand is not drawn from it
  std::array<Joint, kJoints> joints{};  ///< in the order of XR_EXT_hand_tracking
};

/// All hands of one tracker sample.
/// Published by: services/pose ("pose.hands", with history).  Read by: services/projector.
struct HandPoses {
  static constexpr std::string_view layout = "HandPoses/2";  ///< see type_hash()

  Header header;            ///< origin_ns: the sample time of the sensor
  std::uint32_t count = 0;  ///< number of hands
  /// calib::Calibration::id that they were computed with; 0: they depend on none.
  std::uint32_t calibration = 0;
  std::array<HandPose, kMaxHands> hands{};  ///< the first `count` are valid

  /// The hand of this side; null if the sample has none. Points into this message.
  const HandPose* find(Side side) const {
    for (std::uint32_t i = 0; i < count && i < hands.size(); ++i)
      if (hands[i].side == side) return &hands[i];
    return nullptr;
  }
};

}  // namespace handcast::msg
