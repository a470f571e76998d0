// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "ipc/msg/hand_poses.hpp"
#include "services/landmarks/models/landmark_models.hpp"

namespace handcast::landmarks {

/// One confidence per landmark, 0..1.
using Confidences = std::array<float, msg::kLandmarks>;

/// The confidence in each landmark of a hand that was estimated in `region`: the hand's presence,
/// reduced if the landmark's sigma is large or if its finger is not where the tracker has it. (If
/// network and tracker disagree, one of them is wrong: a covered finger looks like a folded one.)
/// Fingers are compared after a shift of the whole hand, because trackers differ in its position.
Confidences confidences_of(const LandmarkEstimate& estimate, const Region& region,
                           const std::optional<Points>& tracker_px);

/// The mean over all landmarks.
float mean_of(const Confidences& confidences);

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
  float comparisons = 0;            ///< of its sides, in left_score; unclear ones count less
};

}  // namespace handcast::landmarks
