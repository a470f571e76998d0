// SPDX-License-Identifier: Apache-2.0
#include "calib/opencv_file.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace handcast::calib {
namespace {

cv::FileStorage read(const std::string& text) {
  return {text, cv::FileStorage::READ | cv::FileStorage::MEMORY};
}

cv::Mat1d matrix(const cv::FileStorage& file, const char* name) {
  cv::Mat read;
  file[name] >> read;
  return read;
}

TEST(OpenCvFile, IsReadByOpenCv) {
  auto calibration = reference_rig();
  calibration.camera_from_tracker[3] = {1, 2, 3, 1};
  calibration.projector.parallax = {0.5, -7, 1e-3};
  const auto file = read(print_opencv_file(calibration));
  EXPECT_EQ(static_cast<int>(file["image_width"]), 720);
  EXPECT_EQ(static_cast<int>(file["projector_height"]), 768);
  EXPECT_EQ(static_cast<double>(file["plane_m"]), calibration.projector.plane_m);
  EXPECT_EQ(matrix(file, "camera_matrix")(0, 2), calibration.camera.cx_px);
  EXPECT_EQ(matrix(file, "distortion_coefficients")(0, 4), calibration.camera.k3);
  EXPECT_EQ(matrix(file, "camera_from_tracker")(1, 3), 2);
  EXPECT_EQ(matrix(file, "projector_from_camera")(0, 1), calibration.projector.from_camera[1][0]);
  EXPECT_EQ(matrix(file, "parallax")(2, 0), 1e-3);
}

TEST(OpenCvFile, KeepsTheCharactersOfNames) {
  auto calibration = reference_rig();
  for (const std::string name : {"", "EPSON PJ", "a \"b\" \\ c: #d", "12"}) {
    calibration.projector_device = name;
    EXPECT_EQ(read(print_opencv_file(calibration))["projector_device"].string(), name);
  }
  calibration.camera_device = "two\nlines";
  EXPECT_EQ(read(print_opencv_file(calibration))["camera_device"].string(), "two lines");
}

}  // namespace
}  // namespace handcast::calib
