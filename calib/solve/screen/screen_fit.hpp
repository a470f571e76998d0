// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/solve/screen/homography_fit.hpp"

namespace handcast::calib {

/// Structured light on a flat board whose pose is known.
struct DepthView {
  std::vector<Correspondence> points;
  glm::dvec4 plane{0, 0, 1, -1};  ///< camera space, metres: plane.xyz * point + plane.w = 0
};

/// Where the projector's centre lies, seen by the camera.
struct Baseline {
  glm::dvec3 projector_mm{0};  ///< in camera space
  double length_mm = 0;
  double interval_mm = 0;  ///< half the width of the 95 % interval of the length
};

/// A projector, fitted to boards at several depths.
struct ScreenFit {
  ProjectorModel model;
  bool coaxial = true;               ///< parallax is 0: it is, or it was not observable
  bool parallax_observable = false;  ///< the boards differ enough in depth
  double inlier_share = 0;           ///< of all points
  ErrorsPx residual;                 ///< of the inliers
  /// Of the inliers by fits without their view; without their part of the image if there are too
  /// few views. `full` is 0 if the parallax was not observable.
  /// @{
  ErrorsPx held_out_coaxial, held_out_full;
  /// @}
  glm::dvec2 depths_m{0};  ///< the least and the greatest depth of an inlier
  /// As in HomographyFit, at depth plane_m.
  /// @{
  std::array<glm::dvec2, 4> corners_px, corner_interval_px;
  /// @}
  std::optional<Baseline> baseline;   ///< of a full model, if its interval does not include 0
  std::vector<std::string> findings;  ///< sentences for a person: what makes the fit doubtful
};

/// Fits a ProjectorModel: the depth of each point is that of its board, the inliers are those of
/// plane_consensus() in each view. `plane_m`: greater than 0. The model is coaxial (8 unknowns)
/// unless the full one (11) predicts what was held out better by 10 %. Two boards determine it
/// unless they are almost in the same plane; one board, also a tilted one, does not. Intervals come
/// from 200 bootstrap samples of the parts of the image, and of the views if there are at least 5;
/// with fewer views they do not include the errors of the boards' poses. Errors: those of
/// plane_consensus() with the number of the view (from 1); bad_data (no view, or a board that is
/// not in front of the camera where its points are).
Result<ScreenFit> fit_screen(std::span<const DepthView> views, const CameraModel& camera,
                             double plane_m, const glm::ivec2& projector_px = {1024, 768});

}  // namespace handcast::calib
