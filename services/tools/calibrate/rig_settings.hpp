// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/tools/calibrate/options.hpp"
#include "services/tools/calibrate/own_devices.hpp"

namespace handcast::calibrate {

/// How the rig runs while it is being calibrated.
struct RunningAs {
  calib::Calibration calibration;     ///< that its services use meanwhile
  std::vector<std::string> settings;  ///< for --set
  /// If the rig's calibration is that of other devices: a part of the names of files for the
  /// devices that the rig has now. Else empty.
  std::string new_devices{};
  bool is_second_guessed = false;  ///< the place of the second camera is not known
};

/// The rig with its own calibration. If it names none and has real devices, or if its calibration
/// is that of other devices than `own`, with one that has only the sizes of the images
/// (options.camera, options.projector) and is written to the session's folder. If only the second
/// camera of two is not calibrated, with a guess of that one. Errors: bad_config (the sizes are
/// missing; --check, --correct or --points, and the calibration is that of other devices), those of
/// calib::load_calibration().
Result<RunningAs> rig_as_it_runs(const Options& options, const config::Rig& rig,
                                 const OwnDevices& own = {});

/// Errors: bad_config (--check, --correct or --points, and the second camera is a guess; a
/// size of --camera, --camera2 or --projector is not that of the calibration in use, and has no
/// effect).
Result<void> check_known(const Options& options, const RunningAs& running);

/// The settings (for --set) with which the twin shows what a step needs, at a rate that leaves a
/// small computer time for it. The board is held longer for a slow camera.
std::vector<std::string> twin_scene(Step step, const Options& options, double camera_hz);

}  // namespace handcast::calibrate
