// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// Checks that a daemon has this back end: runs its program with --backends. That may take a
/// moment, which does not disturb the rig: its data does not pass through the supervisor. Errors:
/// bad_config (the sentence lists the back ends that it has), unavailable (the program does not
/// answer).
Result<void> check_backend(const std::filesystem::path& program_folder, const std::string& service,
                           const std::string& backend);

}  // namespace handcast::supervisor
