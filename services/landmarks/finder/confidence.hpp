// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "services/landmarks/finder/landmark_model.hpp"

namespace handcast::landmarks {

using Confidences = std::array<float, msg::kLandmarks>;

/// How far to believe each landmark of a hand looked for in `region`, 0..1: its presence; less
/// where the network is uncertain, down to 0; less where the finger is not where the tracker has
/// it. Then one of both is wrong: a covered finger looks like a folded one. The hand's place is no
/// matter, trackers differ in that.
Confidences confidences_of(const LandmarkModel::Seen& seen, const Region& region,
                           const std::optional<Points>& tracker_px);

float mean_of(const Confidences& confidences);

}  // namespace handcast::landmarks
