// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/rig.hpp"
#include "services/tools/calibrate/options.hpp"

namespace handcast::calibrate {

/// False for a step that measures what the rig does not have. Poses from two cameras are in the
/// space of the first one: there is no tracker whose place could be wrong.
bool has_need_of(const config::Rig& rig, Step step);

/// The option that compares something with the calibration in use; null if there is none.
const char* what_compares(const Options& options);

/// Errors: bad_config (a step, --correct, --reflector or --camera2 was asked for, which needs a
/// second camera or a tracker that the rig does not have; what_compares(), and the rig names no
/// calibration).
Result<void> check_steps(const Options& options, const config::Rig& rig);

}  // namespace handcast::calibrate
