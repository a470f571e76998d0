// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/calibrate/options.hpp"

namespace handcast::calibrate {

/// How the rig runs while it is being calibrated.
struct RunningAs {
  calib::Calibration calibration;     ///< that its services use meanwhile
  std::vector<std::string> settings;  ///< for --set
};

/// The rig with its own calibration, or, if it names none and has real devices, with one that has
/// only the sizes of the images (options.camera, options.projector) and is written to the session's
/// folder. Errors: bad_config (the sizes are missing), those of calib::load_calibration().
Result<RunningAs> rig_as_it_runs(const Options& options, const config::Rig& rig);

/// The settings (for --set) with which the twin shows what a step needs, at a rate that leaves a
/// small computer time for it.
std::vector<std::string> twin_scene(Step step, const calib::Board& board);

}  // namespace handcast::calibrate
