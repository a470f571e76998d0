// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "services/landmarks/detect/options.hpp"

namespace handcast::detect {

/// Finds, draws and prints. What goes to standard output; progress goes to standard error. Errors:
/// bad_config, bad_data, unavailable.
handcast::Result<std::string> run(const Options& options);

}  // namespace handcast::detect
