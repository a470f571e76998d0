// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/doctor/finding.hpp"

namespace handcast::doctor {

/// Watches a rig that is up for some seconds: services, rates, clocks, losses, images, hands,
/// light. Errors: those of client::open_stream() for its camera, and unavailable (its status cannot
/// be read).
Result<std::vector<Finding>> examine_live(const std::string& rig, double seconds);

}  // namespace handcast::doctor
