// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::chart {

/// Has gnuplot run a script, as a child process that reads no start-up file, and gives what it
/// printed: the SVG. Errors: bad_config (there is no such program), bad_data (it complained of the
/// script), unavailable (no folder for temporary files).
Result<std::string> run_gnuplot(const std::string& script, const std::string& program = "gnuplot");

}  // namespace handcast::chart
