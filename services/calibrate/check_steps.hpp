// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/rig.hpp"
#include "services/calibrate/options.hpp"

namespace handcast::calibrate {

/// False for a step that measures what the rig does not have. Poses from two cameras are in the
/// space of the first one: there is no tracker whose place could be wrong.
bool has_need_of(const config::Rig& rig, Step step);

/// Errors: bad_config (a step, or --correct, was asked for that needs a second camera or a tracker
/// which the rig does not have).
Result<void> check_steps(const Options& options, const config::Rig& rig);

}  // namespace handcast::calibrate
