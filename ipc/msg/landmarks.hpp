// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/header.hpp"

namespace handcast::msg {

/// The landmarks of MediaPipe, in its order: wrist, then thumb to little finger, each from palm to
/// tip.
inline constexpr int kLandmarks = 21;

/// Maps landmarks to joints: landmark i is the image of joint kJointOfLandmark[i].
inline constexpr std::array<int, kLandmarks> kJointOfLandmark{
    1, 2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 20, 22, 23, 24, 25};

/// One landmark in a camera image, lens distortion removed.
struct Landmark {
  /// Position from the centre of the top-left pixel of the camera: x to the right, y down.
  /// @{
  float x_px = 0;
  float y_px = 0;
  /// @}
  float confidence = 0;  ///< 0..1; 0: not seen
  float sigma_px = 0;    ///< standard deviation of x and of y; 0: not reported by the detector
};

/// The landmarks of one hand in one camera frame.
struct HandLandmarks {
  Side side = Side::left;                     ///< as reported by the detector
  float presence = 0;                         ///< 0..1: how likely there is a hand
  std::array<Landmark, kLandmarks> points{};  ///< in the order of MediaPipe
};

/// All hands that were detected in one camera frame.
/// Published by: services/landmarks ("landmarks.hands").  Read by: services/projector.
struct Landmarks {
  static constexpr std::string_view layout = "Landmarks/3";  ///< see type_hash()

  Header header;            ///< frame_id and origin_ns of the camera frame
  std::uint32_t count = 0;  ///< number of hands
  /// calib::Calibration::id of the camera frame; 0: unknown, for any calibration.
  std::uint32_t calibration = 0;
  std::array<HandLandmarks, kMaxHands> hands{};  ///< the first `count` are valid

  /// The hand of this side; null if there is none. Points into this message.
  const HandLandmarks* find(Side side) const {
    for (std::uint32_t i = 0; i < count && i < hands.size(); ++i)
      if (hands[i].side == side) return &hands[i];
    return nullptr;
  }
};

}  // namespace handcast::msg
