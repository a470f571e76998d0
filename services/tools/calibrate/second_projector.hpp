// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "services/tools/calibrate/options.hpp"

namespace handcast::calibrate {

/// Adds settings to `options` with which the projector of the rig is the one that is measured.
///
/// If that is the second one, both change places, and the calibration is that of the rig's camera
/// and tracker with the second projector; it is written to the session's folder. The second
/// calibration thus has the lens of the first one, however old it is. If it is the first one, a
/// second one that is not calibrated yet is left out: it could not start. Errors: bad_config (there
/// is no second projector, the first one is not calibrated, the size of the second one is not
/// known), those of load_calibration() and write_whole().
Result<void> turn_to_projector(const config::Rig& rig, Options& options);

}  // namespace handcast::calibrate
