// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/glm.hpp>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::calib {

/// Pinhole camera with Brown-Conrady distortion (OpenCV's five coefficients k1 k2 p1 p2 k3).
/// Pixels: x right, y down, (0,0) is the centre of the top-left pixel. Camera space: x right, y
/// down, z forward, metres.
struct CameraModel {
  int width_px = 720;
  int height_px = 540;
  double fx_px = 1162.2776, fy_px = 1162.2776;
  double cx_px = 359.5, cy_px = 269.5;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  glm::dmat3 matrix() const;                            ///< K
  glm::dvec2 project(const glm::dvec3& point_m) const;  ///< to undistorted px; z must be > 0
  glm::dvec2 distort(
      const glm::dvec2& undistorted_px) const;  ///< to where the lens puts it in the image
  glm::dvec2 undistort(const glm::dvec2& image_px) const;  ///< the inverse, by Newton iterations
  bool folds() const;  ///< inside the image, where there is then no inverse
};

/// What a calibrated rig knows of itself. Transforms read right to left.
struct Calibration {
  CameraModel camera;
  glm::dmat4 camera_from_tracker{1};  ///< rigid, metres
  glm::dmat3 projector_from_camera{
      1};  ///< homography, undistorted camera px -> projector px (the rig is coaxial)
  int projector_width_px = 1024;
  int projector_height_px = 768;

  /// Undistorted camera px -> projector px.
  glm::dvec2 to_projector(const glm::dvec2& camera_px) const;
  /// Projector px -> undistorted camera px.
  glm::dvec2 to_camera(const glm::dvec2& projector_px) const;
  /// Millimetres on a plane facing the camera at `distance_m`, per projector pixel.
  double mm_per_projector_px(double distance_m) const;
};

/// The rig of the paper, from its authors' published calibration: 720x540 camera, 1024x768 coaxial
/// projector.
Calibration reference_rig();

/// Reads a calibration file (TOML; scalar settings and matrices as rows). Empty path: the reference
/// rig.
Result<Calibration> load_calibration(const std::filesystem::path& file);
std::string print_calibration(const Calibration& calibration);

}  // namespace handcast::calib
