// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::camera::leap {

/// Reads the calibration of a controller and makes a calibration file of its left or right eye, for
/// images of a size; see calibration_file_of(). `wanted`: camera.leap.device. Opens the controller
/// for about a second. Errors: those of open_controller(), read_calibration() and
/// calibration_file_of().
Result<std::string> calibration_file_from(const std::string& wanted, bool of_right_eye,
                                          int width_px, int height_px);

}  // namespace handcast::camera::leap
