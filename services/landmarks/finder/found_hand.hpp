// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

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
  std::optional<Points> before_px;  ///< its points in the last image; empty if not known
  float left_score = 0.5f;          ///< 0..1: how likely it is a left hand; averaged over images
  int comparisons = 0;              ///< how often its sides were compared for left_score
};

}  // namespace handcast::landmarks
