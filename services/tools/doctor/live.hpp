// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// Whether a ring of the supervisor's status holds its rate. `setting`: the path of the rate.
Finding judge_rate(const nlohmann::json& ring, const char* check, const char* setting);

/// Watches a rig that is up for some seconds: services, rates, clocks, losses, images, hands,
/// light. Errors: those of client::open_stream() for its camera, and unavailable (its status cannot
/// be read).
Result<std::vector<Finding>> examine_live(const std::string& rig, double seconds);

}  // namespace handcast::doctor
