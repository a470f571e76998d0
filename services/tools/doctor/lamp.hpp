// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <vector>

#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// Asks the projector of projector.lamp how it is. None if the rig names no such projector.
std::vector<Finding> examine_lamp(const config::Rig& rig,
                                  std::chrono::nanoseconds patience = std::chrono::seconds(3));

}  // namespace handcast::doctor
