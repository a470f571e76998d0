// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::calib {

struct CameraModel;

/// Where the light of a projector falls, seen by the camera: "plane and parallax" (Hartley and
/// Zisserman 2004, Multiple View Geometry, section 13.3). A point with undistorted camera pixel p =
/// (x, y, 1) and depth z (camera z, metres) is lit by the projector pixel
///
///     from_camera * p + parallax * (1 / z - 1 / plane_m),
///
/// divided by its third component. This is any pinhole projector without distortion.
struct ProjectorModel {
  glm::dmat3 from_camera{1};  ///< the homography that holds at depth plane_m
  /// The epipole: the image of the camera's centre in the projector, m times px, in the scale of
  /// the homography. 0: a coaxial projector, whose homography holds at every depth.
  glm::dvec3 parallax{0};
  double plane_m = 0.73;
  /// Size of its image.
  /// @{
  int width_px = 1024;
  int height_px = 768;
  /// @}

  /// The pixel that lights what the camera sees at an undistorted pixel, at depth plane_m.
  glm::dvec2 pixel_of(const glm::dvec2& camera_px) const;
  /// The same at a depth above 0.
  glm::dvec2 pixel_of(const glm::dvec2& camera_px, double depth_m) const;
  /// The undistorted camera pixel of what a pixel lights at depth plane_m.
  glm::dvec2 camera_pixel_of(const glm::dvec2& projector_px) const;
  /// Undistorted camera px to projector px on the plane z = depth_m, which is above 0.
  glm::dmat3 homography_at(double depth_m) const;
  /// The model if another pixel is lit in place of each: `pixels` maps those of this model to them.
  ProjectorModel moved(const glm::dmat3& pixels) const;
  /// The model in the scale in which the lower right element of from_camera is 1.
  ProjectorModel normalised() const;
  /// The projector's centre in camera space, metres: 0 for a coaxial projector. Not finite if the
  /// model is none of a pinhole.
  glm::dvec3 centre_m(const CameraModel& camera) const;
};

/// Maps a pixel by a homography.
glm::dvec2 mapped(const glm::dmat3& homography, const glm::dvec2& px);

}  // namespace handcast::calib
