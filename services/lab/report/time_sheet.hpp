// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "services/lab/report/inputs.hpp"

namespace handcast::report {

/// The HTML of the durations of the stages, live and simulated: median and 99th percentile, as bars
/// and figures.
std::string time_sheet(const Inputs& inputs);

}  // namespace handcast::report
