// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/header.hpp"

namespace handcast::msg {

inline constexpr int kLandmarks =
    21;  ///< MediaPipe's: wrist, then thumb to little finger, each from palm to tip

/// The one table between the two hand models: landmark i is the image of joint kJointOfLandmark[i].
inline constexpr std::array<int, kLandmarks> kJointOfLandmark{
    1, 2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 20, 22, 23, 24, 25};

struct Landmark {
  float x_px =
      0;  ///< right from the centre of the camera's top-left pixel, lens distortion removed
  float y_px = 0;        ///< down from there
  float confidence = 0;  ///< 0..1; 0: not seen
  float sigma_px = 0;    ///< standard deviation of x and of y each; 0: the detector does not say
};

/// The 21 landmarks of one hand as seen in one camera frame.
struct HandLandmarks {
  Side side = Side::left;
  float presence = 0;  ///< 0..1
  std::array<Landmark, kLandmarks> points{};
};

/// Published by: services/landmarks ("landmarks.hands").  Read by: services/projector.
struct Landmarks {
  static constexpr std::string_view layout = "Landmarks/2";

  Header header;  ///< frame_id and origin of the camera frame they were seen in
  std::uint32_t count = 0;
  std::uint32_t reserved = 0;
  std::array<HandLandmarks, kMaxHands> hands{};

  const HandLandmarks* find(Side side) const {
    for (std::uint32_t i = 0; i < count && i < hands.size(); ++i)
      if (hands[i].side == side) return &hands[i];
    return nullptr;
  }
};

}  // namespace handcast::msg
