// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "calib/tracker/pose_refiner.hpp"

namespace handcast::calib {

/// The longest offset of the clocks that is looked for.
inline constexpr double kLongestOffset_s = 0.12;

/// A first pose and offset from points of which many may be wrong: the perspective-n-point problem
/// by random samples (Fischler & Bolles 1981) for offsets in steps of 20 ms; the one with the most
/// points within 4 sigma, at least 6 px. Empty if fewer than 12 points agree.
std::optional<PoseAndOffset> first_pose(std::span<const Sighting> seen, const TrackerPath& path,
                                        const CameraModel& camera);

}  // namespace handcast::calib
