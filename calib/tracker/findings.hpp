// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "calib/tracker/pose_refiner.hpp"

namespace handcast::calib {

/// A sighting with its difference from the fit.
struct Judged {
  Sighting seen;
  glm::dvec3 place_m;  ///< by the tracker and the fit, in camera space
  double error_px = 0;
  bool fits = false;
};

/// Which part of the volume the points that fit have covered.
struct Covered {
  int image_cells = 0;                      ///< of 3 x 3
  double nearest_m = 0, farthest_m = 0;     ///< 5 % and 95 % of the depths
};
Covered covered_by(std::span<const Judged> judged, const CameraModel& camera);

/// The time at which points begin to fit: a beginning of which less than a third does is garbage.
std::int64_t begin_of_fit_ns(std::span<const Judged> judged);

/// Sentences about what is wrong with what was seen: runs of time in which two fingers are exchanged
/// (sets of 21 landmarks only).
std::vector<std::string> exchanged_fingers(std::span<const Judged> judged, const TrackerPath& path,
                                           const CameraModel& camera, const PoseAndOffset& fit,
                                           double sigma_px);

}  // namespace handcast::calib
