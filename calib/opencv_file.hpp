// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/calibration.hpp"

namespace handcast::calib {

/// A calibration as a YAML file for programs that use OpenCV (cv::FileStorage), with the names of
/// OpenCV's own samples: image_width, image_height, camera_matrix, distortion_coefficients (k1, k2,
/// p1, p2, k3); the rest by the names of Calibration. Matrices are of type double, metres and
/// pixels. handcast does not read it.
std::string print_opencv_file(const Calibration& calibration);

}  // namespace handcast::calib
