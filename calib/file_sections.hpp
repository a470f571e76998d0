// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/settings/field.hpp"

/// The sections of a calibration file, declared like those of a rig file (config/settings).
namespace handcast::calib {

using config::between;
using config::Range;

/// The largest width and height of an image.
constexpr int kMostPixels = 8192;

struct CameraSection {
  std::string device;
  int width_px, height_px;
  std::vector<double> focal_px, centre_px, distortion;
};

template <class Visitor>
void describe(Visitor& visitor, CameraSection& camera) {
  visitor.field("device", camera.device,
                "The camera that was calibrated: its serial number, or its name or bus, as "
                "`handcast devices` lists it. With any other one, the rig does not start. Empty: "
                "not known.");
  visitor.field("width_px", camera.width_px, between(16, kMostPixels, "px"), "Width of the image.");
  visitor.field("height_px", camera.height_px, between(16, kMostPixels, "px"),
                "Height of the image.");
  visitor.field("focal_px", camera.focal_px, between(1, 1e6, "px"), "Focal lengths fx, fy.");
  visitor.field("centre_px", camera.centre_px, between(-1e5, 1e5, "px"),
                "Principal point cx, cy; (0, 0) is the centre of the top-left pixel.");
  visitor.field("distortion", camera.distortion, between(-1e3, 1e3),
                "Brown-Conrady coefficients k1, k2, p1, p2, k3.");
}

struct TransformSection {
  std::vector<double> x, y, z;
};

template <class Visitor>
void describe(Visitor& visitor, TransformSection& rows) {
  visitor.field("x", rows.x, between(-1e5, 1e5),
                "Camera x (right) of the three axes of the system that it comes from, and of its "
                "origin.");
  visitor.field("y", rows.y, between(-1e5, 1e5), "Camera y (down) of these.");
  visitor.field("z", rows.z, between(-1e5, 1e5), "Camera z (forward) of these.");
}

struct ProjectorSection {
  std::string device;
  int width_px, height_px;
  std::vector<double> x, y, w;
  double plane_m;
  std::vector<double> parallax;
};

template <class Visitor>
void describe(Visitor& visitor, ProjectorSection& projector) {
  visitor.field("device", projector.device,
                "The projector that was calibrated: the name of the monitor, as `handcast devices` "
                "lists it. With any other one, the rig does not start. Empty: not known.");
  visitor.field("width_px", projector.width_px, between(16, kMostPixels, "px"),
                "Width of the image.");
  visitor.field("height_px", projector.height_px, between(16, kMostPixels, "px"),
                "Height of the image.");
  visitor.field("x", projector.x, Range{},
                "First row of the homography from undistorted camera pixels to projector pixels.");
  visitor.field("y", projector.y, Range{}, "Second row.");
  visitor.field("w", projector.w, Range{}, "Third row: the divisor of both.");
  visitor.field("plane_m", projector.plane_m, between(0.05, 100, "m"),
                "Distance from the camera, along its axis, at which the homography holds.");
  visitor.field(
      "parallax", projector.parallax, between(-1e6, 1e6),
      "Change of the homography's last column for each 1/m that a point is nearer. Zeros: "
      "camera and projector are coaxial, and the homography holds everywhere.");
}

template <class Visitor>
void describe(Visitor& visitor, Made& made) {
  visitor.field("lens", made.lens, "The camera's lens.");
  visitor.field("screen", made.screen, "The projector.");
  visitor.field("tracker", made.tracker, "The tracker's place.");
  visitor.field("lens2", made.lens2, "The second camera's lens.");
  visitor.field("pair", made.pair, "The second camera's place.");
}

struct File {
  CameraSection camera;
  TransformSection camera_from_tracker;
  ProjectorSection projector;
  Made made;
};

template <class Visitor>
void describe(Visitor& visitor, File& file) {
  visitor.section("camera", file.camera, "The infrared camera.");
  visitor.section("camera_from_tracker", file.camera_from_tracker,
                  "Rigid transform, in rows; the last column is in metres.");
  visitor.section("projector", file.projector, "The projector.");
  visitor.section("made", file.made,
                  "When and how well the parts were measured; written by `handcast calibrate`.");
}

/// The file of a rig with a second camera.
struct PairFile : File {
  CameraSection camera2;
  TransformSection camera2_from_camera;
};

template <class Visitor>
void describe(Visitor& visitor, PairFile& file) {
  describe(visitor, static_cast<File&>(file));
  visitor.section("camera2", file.camera2, "The second infrared camera, for hands from two views.");
  visitor.section("camera2_from_camera", file.camera2_from_camera,
                  "Rigid transform from the first camera, in rows as camera_from_tracker.");
}

/// The calibration as the sections of a file. One that lacks a second camera gets the first in its
/// place.
PairFile to_pair_file(const Calibration& calibration);
/// Back again, with lists of the declared lengths. PairFile gives a second camera, File none.
/// @{
Calibration to_calibration(const File& file);
Calibration to_calibration(const PairFile& file);
/// @}

}  // namespace handcast::calib
