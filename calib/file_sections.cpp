// SPDX-License-Identifier: Apache-2.0
#include "calib/file_sections.hpp"

namespace handcast::calib {
namespace {

/// A zero has no sign in a file.
double plain(double value) { return value == 0 ? 0 : value; }

template <class Matrix>
std::vector<double> row_of(const Matrix& matrix, int row) {
  std::vector<double> values(Matrix::length());
  for (int column = 0; column < Matrix::length(); ++column)
    values[column] = plain(matrix[column][row]);
  return values;
}

template <class Matrix>
void set_row(Matrix& matrix, int row, const std::vector<double>& values) {
  for (int column = 0; column < Matrix::length(); ++column) matrix[column][row] = values[column];
}

CameraSection to_section(const std::string& device, const CameraModel& c) {
  return {device,
          c.width_px,
          c.height_px,
          {c.fx_px, c.fy_px},
          {c.cx_px, c.cy_px},
          {plain(c.k1), plain(c.k2), plain(c.p1), plain(c.p2), plain(c.k3)}};
}

TransformSection to_section(const glm::dmat4& transform) {
  return {row_of(transform, 0), row_of(transform, 1), row_of(transform, 2)};
}

File to_file(const Calibration& calibration) {
  const auto& tracker = calibration.camera_from_tracker;
  const auto& homography = calibration.projector.from_camera;
  const auto& e = calibration.projector.parallax;
  return {to_section(calibration.camera_device, calibration.camera),
          to_section(tracker),
          {calibration.projector_device,
           calibration.projector.width_px,
           calibration.projector.height_px,
           row_of(homography, 0),
           row_of(homography, 1),
           row_of(homography, 2),
           calibration.projector.plane_m,
           {plain(e.x), plain(e.y), plain(e.z)}},
          calibration.made};
}

CameraModel to_camera_model(const CameraSection& s) {
  return {s.width_px,      s.height_px,     s.focal_px[0],   s.focal_px[1],
          s.centre_px[0],  s.centre_px[1],  s.distortion[0], s.distortion[1],
          s.distortion[2], s.distortion[3], s.distortion[4]};
}

glm::dmat4 to_transform(const TransformSection& rows) {
  glm::dmat4 transform(1);
  set_row(transform, 0, rows.x);
  set_row(transform, 1, rows.y);
  set_row(transform, 2, rows.z);
  return transform;
}

}  // namespace

PairFile to_pair_file(const Calibration& calibration) {
  const auto& first = calibration.camera;
  const auto second = calibration.camera2.value_or(SecondCamera{{}, first, glm::dmat4(1)});
  return {to_file(calibration), to_section(second.device, second.camera),
          to_section(second.from_camera)};
}

Calibration to_calibration(const File& file) {
  Calibration calibration;
  calibration.camera_device = file.camera.device;
  calibration.projector_device = file.projector.device;
  calibration.camera = to_camera_model(file.camera);
  calibration.camera_from_tracker = to_transform(file.camera_from_tracker);
  const auto& projector = file.projector;
  calibration.projector.width_px = projector.width_px;
  calibration.projector.height_px = projector.height_px;
  set_row(calibration.projector.from_camera, 0, projector.x);
  set_row(calibration.projector.from_camera, 1, projector.y);
  set_row(calibration.projector.from_camera, 2, projector.w);
  calibration.projector.parallax = {projector.parallax[0], projector.parallax[1],
                                    projector.parallax[2]};
  calibration.projector.plane_m = projector.plane_m;
  calibration.made = file.made;
  return calibration;
}

Calibration to_calibration(const PairFile& file) {
  Calibration calibration = to_calibration(static_cast<const File&>(file));
  calibration.camera2 = SecondCamera{file.camera2.device, to_camera_model(file.camera2),
                                     to_transform(file.camera2_from_camera)};
  return calibration;
}

}  // namespace handcast::calib
