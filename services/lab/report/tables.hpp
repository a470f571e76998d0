// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "services/lab/report/inputs.hpp"

namespace handcast::report {

/// The HTML of the sections of the page. A missing source is named in the section.
/// @{
/// The interior error of the three runs.
std::string headline(const Inputs& inputs);
/// The metrics of `docs/method.md#metrics` for the three runs, each with an explanation.
std::string accuracy_table(const Inputs& inputs);
/// Error and coverage by the speed of the hand, as a bar chart and a table.
std::string speed_table(const Inputs& inputs);
/// Requested and measured rates, restarts, and the observer's score.
std::string live_table(const Inputs& inputs);
/// @}

}  // namespace handcast::report
