// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "calib/least_squares/normal_equations.hpp"
#include "calib/solve/tracker/lasting.hpp"
#include "calib/solve/tracker/observations.hpp"

namespace handcast::calib {

/// A small change of a pose: rotation vector about the camera's centre (rad), shift (m) in camera
/// axes, clock offset (s). The camera's centre moves in the tracker's space by minus the shift.
using Change = Eigen::Matrix<double, 7, 1>;
using Curvature = Eigen::Matrix<double, 7, 7>;

/// Sightings that are farther off than this many scales have no weight (Tukey's biweight, with
/// 95 % efficiency for normal errors).
constexpr double kTukey = 4.685;

/// The tracker's common error is taken as constant for so long, and independent after it.
constexpr double kWander_s = 0.25;

TrackerPose moved(const TrackerPose& pose, const Change& change);
/// The change from `a` to `b`, to first order.
Change change_between(const TrackerPose& a, const TrackerPose& b);

/// A pose that minimises the robust cost.
struct Refined {
  TrackerPose pose;
  /// Standard deviation, along each axis, of the error that all points of the tracker share for a
  /// while (kWander_s): an unknown for each of these times. 0: there is none, because fewer than
  /// four points were seen, which cannot tell it from their own.
  double wander_m = 0;
  /// Standard deviation of one coordinate of a sighting that fits and has the median sigma, in px.
  /// From the median distance of those within kTukey scales.
  double scale = 1;
};

/// Tukey's M-estimator by Gauss-Newton steps with reweighting, from a pose near the solution.
/// What the points of one time say about each other is not touched by the tracker's common error,
/// so it counts more than where they are (generalised least squares; the size of that error is
/// estimated with the pose: Dempster, Laird and Rubin 1977).
/// The scale is estimated, at most as for sightings within 3 kNear_px.
/// Nothing if the equations are singular.
std::optional<Refined> refine(const Observations& observations, const TrackerPose& start);

/// The pose with another limit for outliers: so many times that of `refined`, whose scale and
/// wander_m stay. Nothing if the equations are singular.
std::optional<TrackerPose> with_limit(const Observations& observations, const Refined& refined,
                                      double factor);

/// The second derivative of the robust cost and minus its gradient, of each `bin_s` of time. Their
/// sum has no gradient at the solution.
std::vector<NormalEquations> normals_by_time(const Observations& observations,
                                             const Refined& refined, double bin_s);

/// The tracker's common error as the sightings of each kWander_s show it by themselves: right,
/// down, forward of the camera, in metres, relative to its mean. Empty if fewer than four points
/// were seen.
std::array<std::vector<Measured>, 3> common_errors(const Observations& observations,
                                                   const Refined& refined);

}  // namespace handcast::calib
