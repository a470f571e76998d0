// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// What the tracker saw of one hand at one time. Each point has a fixed meaning: 1 for a reflector
/// on a finger tip, 21 for the landmarks of a hand in MediaPipe's order.
struct TrackerSample {
  std::int64_t time_ns = 0;          ///< by the tracker's clock
  std::vector<glm::dvec3> points_m;  ///< in the tracker's axes; as many in each sample
};

/// One point of the hand in one camera image.
struct Sighting {
  std::int64_t time_ns = 0;      ///< by the camera's clock: the middle of the exposure
  int point = 0;                 ///< index in TrackerSample::points_m
  glm::dvec2 undistorted_px{0};  ///< as CameraModel::undistort() returns it
  /// Standard deviation of each coordinate, greater than 0. Only the ratios between sightings
  /// matter; the common factor is estimated.
  double sigma_px = 1;
};

/// How well a value is known. `low` and `high` are relative to the estimate: the truth lies between
/// estimate + low and estimate + high with 95 % probability.
struct Interval {
  double sd = 0, low = 0, high = 0;
};

/// The median and the 95th percentile of distances in the image.
struct Residuals {
  double median_px = 0, p95_px = 0;
};

/// How far the fitted tracker is expected to be off at a place (root of the mean square).
struct PlaceError {
  glm::dvec3 place_m{0};  ///< in camera space
  double light_mm = 0;    ///< across the camera's ray: how far light lands beside its target
  double whole_mm = 0;    ///< in space, with the error along the ray
};

/// What a fit is good for. Good: light lands within 2 mm at the corners of the observed volume
/// (standard deviation 1 mm), the clock offset is known to 2 ms (95 %), 60 % of the sightings fit,
/// held-out sightings are off by at most 3 px in the median (4 mm on a hand, whose landmarks are
/// never quite the tracker's joints, if that is more), and the points cover 15 % of the image and
/// 10 cm of depth. Poor: the standard deviation of light exceeds 3 mm, that of the camera's
/// place exceeds 10 mm along any axis, fewer than 40 % fit, held-out sightings are off by more than
/// 6 px (8 mm on a hand), the points cover less than 8 % of the image or 5 cm of depth, or a second
/// pose, a mirrored hand or an offset at the edge of the search is possible. Usable: all else.
enum class Quality { good, usable, poor };

struct TrackerFit {
  glm::dmat4 camera_from_tracker{1};  ///< rigid, in metres
  /// The tracker's clock minus the camera's at one instant: what the camera saw at its time t, the
  /// tracker saw at its time t + clock_offset_ns.
  std::int64_t clock_offset_ns = 0;

  double inlier_share = 0;  ///< of the sightings for which the tracker has a position
  Residuals inliers;
  /// Of poses that were fitted without the fifth of the time that contains the sightings.
  Residuals held_out;

  /// Uncertainties by a bootstrap over blocks of time, to which the change is added that a stricter
  /// and a looser limit for outliers cause. Axes: right, down, forward of the camera.
  /// @{
  std::array<Interval, 3> camera_place_mm;  ///< of the camera's centre in the tracker's space
  std::array<Interval, 3> rotation_deg;     ///< about the axes through the camera's centre
  Interval clock_offset_ms;
  /// @}
  /// At the middle of the observed volume, then at the 8 corners of its box in camera space.
  std::array<PlaceError, 9> place_errors;

  Quality quality = Quality::poor;
  std::vector<std::string> findings;  ///< sentences for a person, the most important first
};

/// Finds where the tracker is in camera space, and the offset between the clocks of both, within
/// +-100 ms. Method: P3P on random triples of sightings (RANSAC, truncated squares) for a grid of
/// offsets, then Tukey's M-estimator for pose and offset together. The tracker's positions are
/// smoothed over 80 ms and interpolated. The result depends only on the input. Up to a second of
/// computation. Errors: bad_data (too little data, no common time, clocks that stand still, points
/// at one place or on one line, no pose that fits).
Result<TrackerFit> fit_tracker(const CameraModel& camera, std::span<const TrackerSample> samples,
                               std::span<const Sighting> sightings);

}  // namespace handcast::calib
