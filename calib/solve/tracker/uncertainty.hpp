// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/tracker/refine.hpp"

namespace handcast::calib {

/// How far a pose may be off, from the sightings themselves. The errors of neighbouring times are
/// correlated (the tracker's bias drifts slowly), so that only blocks of time vary independently.
struct Uncertainty {
  Curvature covariance;  ///< of the change from the estimate to the truth
  double width = 0;      ///< half of a 95 % interval, in standard deviations: Student's t
  /// The largest change of the camera's place by a stricter or looser limit for outliers.
  double limit_shift_mm = 0;

  Interval spread(int unknown, double factor) const;
  /// For a place in camera space.
  PlaceError place_error(const glm::dvec3& place_m) const;
};

/// Moving blocks with ends that wrap (Politis and Romano 1992) of an eighth of the time, at most
/// 2.5 s; each resample is one Newton step from the estimate. The change by stricter and looser
/// limits for outliers is added as variance, and so is what the blocks do not see of the mean of
/// the tracker's common error, whose duration is estimated (variance_of_mean()).
Uncertainty uncertainty_of(const Observations& observations, const Refined& refined);

/// Distances of the sightings within kTukey scales to poses that were fitted (by one Newton step)
/// without their fifth of the time.
Residuals held_out(const Observations& observations, const Refined& refined);

}  // namespace handcast::calib
