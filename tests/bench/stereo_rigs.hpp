// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration.hpp"

namespace handcast::bench {

/// Two cameras before the twin's hands.
struct StereoRig {
  std::string name;
  /// Both cameras as their landmarks have them: square pixels.
  calib::Calibration calibration;
  int rows_per_row = 1;        ///< rows of these images for each row of the sensor
  double rate_hz = 0;          ///< of samples
  double second_later_ms = 0;  ///< between the exposures of the two cameras
  double gain = 0;             ///< twin.image.gain that exposes the hands well
};

/// The geometry of a Leap Motion Controller: 40 mm apart, wide lenses, 640 x 240 px whose rows are
/// twice as far apart as their columns; 0.28 m in front of the hands. Its focal length is assumed.
StereoRig leap_rig();
/// Two cameras of 720 x 540 px, 0.3 m apart, 0.73 m in front of the hands; the first one is that of
/// the reference rig. They are not triggered together.
StereoRig gige_rig();

}  // namespace handcast::bench
