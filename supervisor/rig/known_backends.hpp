// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// Whether a daemon has this back end, which its program is asked for: that may take a moment, and
/// the rig's data path does not pass through the supervisor. Errors: bad_config, with the back ends
/// that there are; unavailable (the program does not answer).
Result<void> check_backend(const std::filesystem::path& program_folder, const std::string& service,
                           const std::string& backend);

}  // namespace handcast::supervisor
