// SPDX-License-Identifier: Apache-2.0
#include "calib/opencv_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace handcast::calib {
namespace {

std::string matrix_text(const char* name, int rows, int columns,
                        const std::vector<double>& values) {
  return fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: d\n   data: [ {} ]\n",
                     name, rows, columns, fmt::join(values, ", "));
}

/// The elements row by row; glm's are column by column.
template <class Matrix>
std::vector<double> rows_of(const Matrix& matrix) {
  std::vector<double> values;
  values.reserve(sizeof(Matrix) / sizeof(double));
  for (int row = 0; row < Matrix::col_type::length(); ++row)
    for (int column = 0; column < Matrix::length(); ++column) values.push_back(matrix[column][row]);
  return values;
}

std::string text_line(const char* name, const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return fmt::format("{}: \"{}\"\n", name, quoted);
}

}  // namespace

static std::string second_camera_text(const SecondCamera& second) {
  const auto& lens = second.camera;
  return fmt::format("camera2_width: {}\ncamera2_height: {}\n", lens.width_px, lens.height_px) +
         text_line("camera2_device", second.device) +
         matrix_text("camera2_matrix", 3, 3, rows_of(lens.matrix())) +
         matrix_text("camera2_distortion_coefficients", 1, 5,
                     {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3}) +
         matrix_text("camera2_from_camera", 4, 4, rows_of(second.from_camera));
}

std::string print_opencv_file(const Calibration& calibration) {
  const auto& camera = calibration.camera;
  const auto& parallax = calibration.projector.parallax;
  return fmt::format("%YAML:1.0\n---\nimage_width: {}\nimage_height: {}\n", camera.width_px,
                     camera.height_px) +
         text_line("camera_device", calibration.camera_device) +
         matrix_text("camera_matrix", 3, 3, rows_of(camera.matrix())) +
         matrix_text("distortion_coefficients", 1, 5,
                     {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3}) +
         matrix_text("camera_from_tracker", 4, 4, rows_of(calibration.camera_from_tracker)) +
         fmt::format("projector_width: {}\nprojector_height: {}\n", calibration.projector.width_px,
                     calibration.projector.height_px) +
         text_line("projector_device", calibration.projector_device) +
         matrix_text("projector_from_camera", 3, 3, rows_of(calibration.projector.from_camera)) +
         matrix_text("parallax", 3, 1, {parallax.x, parallax.y, parallax.z}) +
         fmt::format("plane_m: {:#}\n", calibration.projector.plane_m) +
         (calibration.camera2 ? second_camera_text(*calibration.camera2) +
                                    text_line("made_lens2", calibration.made.lens2) +
                                    text_line("made_pair", calibration.made.pair)
                              : std::string()) +
         text_line("made_lens", calibration.made.lens) +
         text_line("made_screen", calibration.made.screen) +
         text_line("made_tracker", calibration.made.tracker);
}

}  // namespace handcast::calib
