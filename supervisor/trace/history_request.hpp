// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// What a rig remembers of its last `seconds`. Errors: unavailable, bad_data.
Result<HistorySnapshot> ask_for_history(const std::string& rig, double seconds);

/// The rates that are asked of a rig's services, by service; those that run as fast as they can are
/// not in it. Errors: unavailable, bad_data.
Result<std::map<std::string, double>> ask_for_rates(const std::string& rig);

}  // namespace handcast::supervisor
