// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/tools/calibrate/options.hpp"

namespace handcast::calibrate {

/// Corrects the place of a tracker that has moved a little, by hands that are held still in front
/// of a rig that is up (calib::DriftWatch): shows what it found, asks, and writes the calibration
/// file; the one before it is kept. `used`: the calibration of the rig's services. Errors:
/// bad_config (the rig names no calibration), bad_data (the tracker has not moved beyond doubt, or
/// too far), those of the streams and of the file.
Result<void> correct_tracker(const Options& options, const config::Rig& rig,
                             const calib::Calibration& used);

}  // namespace handcast::calibrate
