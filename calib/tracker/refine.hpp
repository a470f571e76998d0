// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calib/tracker/observations.hpp"

namespace handcast::calib {

/// A small change of a pose: rotation vector about the camera's centre (rad), shift (m) in camera
/// axes, clock offset (s). The camera's centre moves in the tracker's space by minus the shift.
using Change = Eigen::Matrix<double, 7, 1>;
using Curvature = Eigen::Matrix<double, 7, 7>;

/// Sightings that are farther off than this many scales have no weight (Tukey's biweight, with
/// 95 % efficiency for normal errors).
constexpr double kTukey = 4.685;

Pose moved(const Pose& pose, const Change& change);
/// The change from `a` to `b`, to first order.
Change change_between(const Pose& a, const Pose& b);

/// A pose that minimises the robust cost.
struct Refined {
  Pose pose;
  /// Standard deviation of one coordinate of a sighting that fits and has the median sigma, in px.
  /// From the median distance of those within kTukey scales.
  double scale = 1;
};

/// Tukey's M-estimator by Gauss-Newton steps with reweighting, from a pose near the solution.
/// `scale`: the scale; if absent, it is estimated, at most as for
/// sightings within 3 kNear_px.
/// Nothing if the equations are singular.
std::optional<Refined> refine(const Observations& observations, const Pose& start,
                              std::optional<double> scale = {});

/// The second derivative of the robust cost and minus its gradient, over a part of the sightings.
struct Normal {
  Curvature curvature = Curvature::Zero();
  Change gradient = Change::Zero();
};
/// Of each `bin_s` of time. Their sum has no gradient at the solution.
std::vector<Normal> normals_by_time(const Observations& observations, const Refined& refined,
                                    double bin_s);

}  // namespace handcast::calib
