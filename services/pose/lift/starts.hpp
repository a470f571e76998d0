// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "services/pose/lift/fit.hpp"

namespace handcast::pose {

/// Postures from which to fit a hand of which nothing is known: the palm as the image shows its
/// direction and its side, tilted in four ways, the fingers at rest. `log_size`: see Posture.
/// Landmarks that were not seen must have a place, too.
std::array<Posture, 4> starts_for(const Skeleton& skeleton, const calib::CameraModel& camera,
                                  double distance_m, const SeenHand& seen, double log_size);

/// The other posture of a palm that a distant camera could not distinguish: its depths are
/// mirrored. The fingers are at rest.
Posture mirrored_in_depth(const Posture& posture);

/// The posture with the fingers at rest.
Posture with_fingers_at_rest(Posture posture);

}  // namespace handcast::pose
