// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "services/landmarks/models/landmark_model.hpp"

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

}  // namespace handcast::landmarks
