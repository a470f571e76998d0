// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>

#include "services/tools/calibrate/options.hpp"

namespace handcast::calibrate {

/// Error bad_config: options that do not go together, of which one would have no effect. `app`: the
/// options as they were given.
Result<void> check_combination(const CLI::App& app, const Options& options);

}  // namespace handcast::calibrate
