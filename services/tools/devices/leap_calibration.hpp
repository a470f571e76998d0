// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::devices {

/// What of a Leap Motion Controller's own calibration is written.
struct LeapCalibration {
  std::string file;              ///< must not exist
  std::string device;            ///< serial number or USB port; empty: the only one
  std::string eye = "left";      ///< or "right"
  std::string size = "640x480";  ///< of the images
};

/// Writes a calibration file with the lenses that the controller has measured itself. Errors:
/// bad_config (the file exists or cannot be written, no such size or eye, lenses that no program
/// would accept, not in this build), those of the controller. After an error the file is not there,
/// unless it was before.
Result<void> write_leap_calibration(const LeapCalibration& wanted);

}  // namespace handcast::devices
