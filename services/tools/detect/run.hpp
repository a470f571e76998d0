// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "services/tools/detect/options.hpp"

namespace handcast::detect {

/// Detects hands in the pictures and draws them; returns the text for standard output. Progress
/// goes to standard error. Errors: bad_config, bad_data, unavailable.
handcast::Result<std::string> run(const Options& options);

}  // namespace handcast::detect
