// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::chart {

/// Runs a script with gnuplot and returns its output, an SVG. Blocks until the child process ends;
/// it does not read start-up files. Errors: bad_config (there is no such program), bad_data (the
/// script failed), unavailable (there is no folder for temporary files).
Result<std::string> run_gnuplot(const std::string& script, const std::string& program = "gnuplot");

}  // namespace handcast::chart
