// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "services/pose/lift/fit.hpp"

namespace handcast::pose::stereo {

/// A hand with fewer seen landmarks is not used.
inline constexpr int kFewestSeen = 8;

/// The landmarks of a hand with their weights: the detector's sigma, to which the differences
/// between hand and model are added, divided by its confidence. Empty if too few were seen, they
/// lie too close together, or a number is not finite.
std::optional<SeenHand> read(const msg::HandLandmarks& landmarks);

/// The root mean square distance of the landmarks from their mean, px: 45 to 65 mm on a hand.
double extent_px(const std::array<glm::dvec2, msg::kLandmarks>& px);

}  // namespace handcast::pose::stereo
