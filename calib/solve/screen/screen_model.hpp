// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

#include "calib/calibration.hpp"

namespace handcast::calib {

/// Where the light of the projector falls, seen by the camera: "plane and parallax" (Hartley and
/// Zisserman, Multiple View Geometry, section 13.3). A point with undistorted camera pixel p = (x,
/// y, 1) and depth z (camera z, metres) is lit by the projector pixel
///   projector_from_camera * p + parallax * (1 / z - 1 / plane_m),
/// divided by its third component. This is any pinhole projector without distortion.
/// The scale is such that projector_from_camera[2][2], its lower right element, is 1.
struct ScreenModel {
  glm::dmat3 projector_from_camera{1};  ///< the homography that holds at depth plane_m
  /// The epipole: the image of the camera's centre in the projector, m times px, in the scale of
  /// the homography. 0: a coaxial projector, whose homography holds at every depth.
  glm::dvec3 parallax{0};
  double plane_m = 1;  ///< depth at which the homography holds

  /// The projector pixel that lights what the camera sees at a pixel. `depth_m`: greater than 0.
  glm::dvec2 to_projector(const glm::dvec2& undistorted_px, double depth_m) const;
  /// Undistorted camera px to projector px on the plane z = depth_m; its [2][2] is 1.
  glm::dmat3 homography_at(double depth_m) const;
  /// The model in the scale in which projector_from_camera[2][2] is 1.
  ScreenModel normalised() const;
  /// The projector's centre in camera space, metres: 0 for a coaxial projector. Not finite if the
  /// model is none of a pinhole.
  glm::dvec3 projector_centre_m(const CameraModel& camera) const;
};

/// Maps a pixel by a homography.
glm::dvec2 mapped(const glm::dmat3& homography, const glm::dvec2& px);

}  // namespace handcast::calib
