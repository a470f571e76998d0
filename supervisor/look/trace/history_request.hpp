// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// Requests the history of the last `seconds` from a rig. Errors: unavailable (the rig does not
/// answer), bad_data (the answer is invalid).
Result<HistorySnapshot> ask_for_history(const std::string& rig, double seconds);

/// Requests the configured rates of the services of a rig in Hz, by service. Services without a
/// fixed rate are left out. Errors: unavailable (the rig does not answer), bad_data (the answer is
/// invalid).
Result<std::map<std::string, double>> ask_for_rates(const std::string& rig);

}  // namespace handcast::supervisor
