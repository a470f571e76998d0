// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/solve/tracker/observations.hpp"

namespace handcast::calib {

/// Sightings that are farther from the projected point count as outliers in the search.
constexpr double kNear_px = 10;

/// A pose from three sightings, and how well it fits the others.
struct Hypothesis {
  TrackerPose pose;
  double cost_px2 = 0;  ///< mean of the squared distances, each at most kNear_px^2
};

/// P3P on random triples of sightings for each of a grid of clock offsets (Fischler and Bolles
/// 1981, with truncated squares as Torr and Zisserman 2000). Returns the best hypotheses of all
/// offsets, the best first; empty if no triple has a solution. The result is the same each time.
std::vector<Hypothesis> first_poses(const Observations& observations);

}  // namespace handcast::calib
