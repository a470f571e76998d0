// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "services/lab/sweep/runs.hpp"
#include "services/lab/sweep/table.hpp"

namespace handcast::sweep {

/// The heading of the results of a plan. `version` is that of the program.
Heading heading_of(const Plan& plan, const Expansion& expansion, std::string_view version);

/// The line of a run with the metrics of simulate::score().
Row scored_row(const Plan& plan, const Run& run, const nlohmann::json& metrics);
/// The line of a run that failed.
Row failed_row(const Plan& plan, const Run& run, const std::string& error);

/// True for a column of times measured on this machine, which differ when a run is repeated.
bool is_machine_time(std::string_view column);

}  // namespace handcast::sweep
