// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/calibration.hpp"
#include "config/sections/leap.hpp"
#include "services/camera/leap/calibration_block.hpp"

namespace handcast::camera::leap {

/// The camera model that comes nearest to an eye's own.
struct LensFit {
  calib::CameraModel camera;  ///< for images of the size that was asked for
  /// Distance between where the model and the controller's calibration have the image of a ray,
  /// over the whole image and over its inner half (in each direction).
  /// @{
  double rms_px = 0, worst_px = 0;
  double inner_rms_px = 0;
  /// @}
};

/// Fits our model to an eye for images of a size, by Levenberg and Marquardt. Lower images are
/// taken as the sensor's with rows put together, narrower ones as cut from the middle. Errors:
/// bad_data (the eye's lens folds; no model without a fold comes near).
Result<LensFit> fit_lens(const EyeCalibration& eye, int width_px, int height_px);

/// A calibration file for images of a size: the lens of `eye`, and that of the other one with its
/// place as the second camera. Tracker and projector are not in it: it has neutral ones. `serial`:
/// of the controller, may be empty. Errors: those of fit_lens().
Result<std::string> calibration_file_of(const ControllerCalibration& calibration,
                                        const std::string& serial, config::Eye eye, int width_px,
                                        int height_px);

}  // namespace handcast::camera::leap
