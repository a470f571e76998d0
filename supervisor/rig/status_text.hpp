// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace handcast::supervisor {

/// The answer of status_of() as `handcast status` prints it.
std::string print_status(const nlohmann::json& status);

}  // namespace handcast::supervisor
