// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "ipc/msg/hand_poses.hpp"

/// How Leap Motion counts joints and bones, beside XR_EXT_hand_tracking's 26 joints.
/// 42 joints: 0 elbow, 1 wrist, 2+8f+2k and 3+8f+2k the ends of bone k (0 metacarpal ... 3 distal)
/// of finger f (0 thumb ... 4 little). 22 bones: 0 palm, 1 arm, 2+4f+k finger f bone k. The thumb's
/// metacarpal has no length: its bones 1-3 are what XR calls metacarpal to distal.
namespace handcast::twin {

inline constexpr int kLeapJoints = 42;
inline constexpr int kLeapBones = 22;
inline constexpr int kPalm = 0, kWrist = 1;  ///< XR joints
inline constexpr int kMiddleMetacarpal =
    11;  ///< XR joint; the palm joint is half-way along this bone

/// XR joint -> Leap joint. -1: the palm, which Leap does not report.
inline constexpr std::array<int, msg::kJoints> kLeapJoint{-1, 1,  3,  5,  7,  9,  10, 11, 13,
                                                          15, 17, 18, 19, 21, 23, 25, 26, 27,
                                                          29, 31, 33, 34, 35, 37, 39, 41};
/// XR joint -> Leap bone that gives its axes: the bone that starts there; a tip has its distal
/// bone's.
inline constexpr std::array<int, msg::kJoints> kLeapBone{
    0, 0, 3, 4, 5, 5, 6, 7, 8, 9, 9, 10, 11, 12, 13, 13, 14, 15, 16, 17, 17, 18, 19, 20, 21, 21};

}  // namespace handcast::twin
