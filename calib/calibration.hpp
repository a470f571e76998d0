// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "calib/projector_model.hpp"
#include "config/sections/viewpoint.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// A pinhole camera with Brown-Conrady distortion (the coefficients k1, k2, p1, p2, k3 of OpenCV).
/// Pixels: x to the right, y down, (0, 0) is the centre of the top-left pixel. Camera space: x to
/// the right, y down, z forward, in metres.
struct CameraModel {
  /// Size of the image in pixels.
  /// @{
  int width_px = 720;
  int height_px = 540;
  /// @}
  /// Focal lengths fx, fy, principal point cx, cy, and distortion coefficients.
  /// @{
  double fx_px = 1162.2776, fy_px = 1162.2776;
  double cx_px = 359.5, cy_px = 269.5;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  /// @}

  /// The camera matrix K.
  glm::dmat3 matrix() const;
  /// Maps a point in camera space to undistorted pixels. z must be greater than 0.
  glm::dvec2 project(const glm::dvec3& point_m) const;
  /// The derivative of project() by the point, px per m.
  glm::dmat3x2 jacobian_px_per_m(const glm::dvec3& point_m) const;
  /// Maps undistorted pixels to pixels of the image as the lens forms it.
  glm::dvec2 distort(const glm::dvec2& undistorted_px) const;
  /// The inverse of distort(), computed by Newton's method.
  glm::dvec2 undistort(const glm::dvec2& image_px) const;
  /// True if a place is in the image: within half a pixel of the centres of its outer pixels.
  bool contains(const glm::dvec2& image_px) const {
    return image_px.x > -0.5 && image_px.y > -0.5 && image_px.x < width_px - 0.5 &&
           image_px.y < height_px - 0.5;
  }
  /// True if the distortion has no inverse somewhere inside the image.
  bool folds() const;
};

/// How and when the parts of a calibration were measured, for people: a sentence for each, empty if
/// it is not known.
struct Made {
  std::string lens, screen, tracker;
  std::string lens2, pair;  ///< the lens and the place of the second camera
};

/// A second camera, for hands from two views (pose.backend = "stereo").
struct SecondCamera {
  std::string device;         ///< as Calibration::camera_device
  CameraModel camera;         ///< its lens
  glm::dmat4 from_camera{1};  ///< from the space of the other camera to its own; rigid, in metres
};

/// A second projector, which lights the same hands from another side.
struct SecondProjector {
  std::string device;  ///< as Calibration::projector_device
  ProjectorModel model;
};

/// The calibration of a rig: camera, tracker and projector. The names of transforms read from right
/// to left.
struct Calibration {
  /// Tells the calibrations of files apart: a hash of all that was read, never 0. Messages carry
  /// it, so that no service takes the pixels of one calibration for those of another.
  std::uint32_t id = 0;
  /// The devices that were calibrated, as `handcast devices` names them; empty: not known.
  /// @{
  std::string camera_device;
  std::string projector_device;
  /// @}
  CameraModel camera;                   ///< the infrared camera
  std::optional<SecondCamera> camera2;  ///< empty: the rig has one camera
  glm::dmat4 camera_from_tracker{1};    ///< rigid, in metres
  ProjectorModel projector;
  std::optional<SecondProjector> projector2;  ///< empty: the rig has one; not a part of `id`
  Made made;                                  ///< not a part of `id`

  /// Maps homogeneous points in camera space, metres, to homogeneous projector pixels, whose third
  /// component is the distance along the projector's axis, metres.
  glm::dmat4x3 projection() const;
  /// The angle between camera and projector, degrees, seen from what is in the middle of the
  /// camera's image at depth plane_m.
  double degrees_apart() const;
  /// Size of a projector pixel in millimetres on a plane that faces the camera at `distance_m`.
  double mm_per_projector_px(double distance_m) const;
};

/// The rig of the paper, from the calibration that its authors published: 720x540 camera, 1024x768
/// coaxial projector.
Calibration reference_rig();

/// One camera of a rig, for code that works for any of them.
struct PlacedCamera {
  std::string device;          ///< as Calibration::camera_device
  CameraModel model;           ///< its lens
  glm::dmat4 from_tracker{1};  ///< from the space of the tracker to its own; rigid, in metres
};

/// The first camera of a rig.
PlacedCamera first_camera(const Calibration& calibration);
/// The camera at a viewpoint. Errors: bad_config (the calibration has no second camera).
Result<PlacedCamera> camera_at(const Calibration& calibration, config::Viewpoint at);

/// The calibration as the projector at a viewpoint has it: `projector` is its own, `projector2` the
/// other one. There must be a second one for the second viewpoint.
Calibration at_projector(Calibration calibration, config::Viewpoint at);

/// Reads a calibration file: TOML, with matrices as rows. An empty path gives the reference rig; a
/// frozen file (config::freeze()) is read like the file. Errors: bad_config (the file cannot be
/// read, is no TOML, is not whole, or has invalid values; one line for each fault).
Result<Calibration> load_calibration(const std::filesystem::path& file);
/// Errors: bad_config (the calibration was made with another device). `what`: "camera".
/// `calibrated`: one of the devices in the calibration; `names`: by which the device is known.
Result<void> check_device(std::string_view what, std::string_view calibrated,
                          std::initializer_list<std::string_view> names);

/// The calibration as a commented file that load_calibration() reads back.
std::string print_calibration(const Calibration& calibration);

}  // namespace handcast::calib
