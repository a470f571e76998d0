// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "ipc/msg/hand_poses.hpp"
#include "services/landmarks/finder/confidence.hpp"

namespace handcast::landmarks {

/// A hand in an image.
struct FoundHand {
  msg::Side side = msg::Side::left;               ///< which hand it is
  float presence = 0;                             ///< 0..1: how likely there is a hand
  Points points_px{};                             ///< in the image, as the model defines them
  Region region;                                  ///< the part of the image they were estimated in
  std::array<float, msg::kLandmarks> sigma_px{};  ///< standard deviation per axis; 0: not known
  Confidences confidences{};                      ///< of the points, 0..1
  float left_score = 0.5f;  ///< 0..1: how likely it is a left hand; averaged over images
};

}  // namespace handcast::landmarks
