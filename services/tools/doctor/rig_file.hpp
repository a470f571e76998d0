// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// Judges a rig file, its calibration, and the display that they mean. `rig`: the result of
/// config::load_rig().
std::vector<Finding> examine_file(const Result<config::Rig>& rig);

}  // namespace handcast::doctor
