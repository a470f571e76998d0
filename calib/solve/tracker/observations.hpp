// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "calib/solve/tracker/fit_tracker.hpp"
#include "calib/solve/tracker/track.hpp"

namespace handcast::calib {

/// A sighting whose time is in seconds since the first sample of the tracker.
struct TimedSighting {
  double time_s = 0;
  int point = 0;
  glm::dvec2 px{0};
  double sigma = 1;  ///< standard deviation relative to the median one
};

/// The clock offset is searched in +- this.
constexpr double kSearch_s = 0.1;

/// What is to be found: camera space = rotation * tracker space + translation, and the tracker's
/// clock minus the camera's.
struct TrackerPose {
  glm::dmat3 rotation{1};
  glm::dvec3 translation_m{0};
  double offset_s = 0;

  glm::dvec3 apply(const glm::dvec3& tracker_m) const {
    return rotation * tracker_m + translation_m;
  }
};

/// The angle of the rotation between two poses.
double angle_between_rad(const TrackerPose& a, const TrackerPose& b);

/// The input of a fit, checked and sorted by time.
struct Observations {
  CameraModel camera;
  Track track;
  std::vector<TimedSighting> sightings;
  int unusable_sightings = 0;  ///< left out: numbers that are not finite or not positive
  int unusable_samples = 0;

  /// The distance between each sighting and the projected point, in px. NaN if the tracker has no
  /// position at that time; infinite if the point is behind the camera.
  std::vector<double> distances_px(const TrackerPose& pose) const;
};

/// Errors: bad_data (see fit_tracker()).
Result<Observations> observe(const CameraModel& camera, std::span<const TrackerSample> samples,
                             std::span<const Sighting> sightings);

/// Errors: bad_data (too few sightings, or in less than 2 s).
Result<void> check_amount(const Observations& observations);

/// Where the points were while the camera saw them, in metres.
struct Extent {
  glm::dvec3 axes_m{0};  ///< standard deviations along the principal axes, the largest first
  double motion_m = 0;   ///< standard deviation of the middle of all points over time
};
Extent extent_of(const Observations& observations);

}  // namespace handcast::calib
