// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "calib/solve/screen/plane_consensus.hpp"

namespace handcast::calib {

/// How far a model is from points, in projector pixels.
struct ErrorsPx {
  double median = 0, p95 = 0;
};

/// A coaxial projector, fitted to points on one plane.
struct HomographyFit {
  glm::dmat3 projector_from_camera{1};  ///< undistorted camera px to projector px; [2][2] is 1
  double inlier_share = 0;              ///< of all points
  ErrorsPx residual;                    ///< of the inliers
  ErrorsPx held_out;  ///< of the inliers, each by a fit without its part of the image
  /// The projector picture's corners in the camera's undistorted pixels, clockwise from the top
  /// left, and half the width of their 95 % intervals in x and y. Corners outside the points are
  /// extrapolated, which makes their intervals wide.
  /// @{
  std::array<glm::dvec2, 4> corners_px;
  std::array<glm::dvec2, 4> corner_interval_px;
  /// @}
  double covered_share = 0;           ///< of the parts of the camera's image (8 x 6): hold points
  bool mirrored = false;              ///< the camera sees the picture mirrored
  std::vector<std::string> findings;  ///< sentences for a person: what makes the fit doubtful
};

/// Fits the homography of a coaxial projector to points on a flat board: plane_consensus(), then
/// least squares. The intervals come from 200 bootstrap samples of the parts of the image, so they
/// include errors that neighbouring points share. `projector_px`: size of its picture.
/// Errors: those of plane_consensus().
Result<HomographyFit> fit_homography(std::span<const Correspondence> points,
                                     const CameraModel& camera,
                                     const glm::ivec2& projector_px = {1024, 768});

}  // namespace handcast::calib
