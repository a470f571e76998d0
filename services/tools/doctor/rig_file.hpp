// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// The mode of a display.
struct DisplayMode {
  std::string display;  ///< for people: "'HDMI-1' (EPSON PJ, 1280x800, 60 Hz)"
  /// Size in pixels.
  /// @{
  int width_px = 0, height_px = 0;
  /// @}
  double rate_hz = 0;  ///< 0: unknown
};

/// Judges a mode by the projector of the calibration and projector.rate_hz.
std::vector<Finding> judge_mode(const DisplayMode& mode, const config::Projector& projector,
                                const calib::Calibration& calibration);

/// Looks for the display of a rig whose projector is a window or a connector, and judges its mode.
/// No findings for other projectors.
std::vector<Finding> examine_display(const config::Rig& rig, const calib::Calibration& calibration);

/// Judges a rig file, its calibration, and the display that they mean. `rig`: the result of
/// config::load_rig().
std::vector<Finding> examine_file(const Result<config::Rig>& rig);

}  // namespace handcast::doctor
