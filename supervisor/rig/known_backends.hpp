// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "config/rig.hpp"
#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// Checks that a daemon has this back end: runs its program with --backends. That may take a
/// moment, which does not disturb the rig: its data does not pass through the supervisor. Errors:
/// bad_config (the sentence lists the back ends that it has), unavailable (the program does not
/// answer).
Result<void> check_backend(const std::filesystem::path& program_folder, const std::string& service,
                           const std::string& backend);

/// The present name of the back end that `word` names for `service`. Errors (bad_config): an old
/// word that also stands for a second setting, of which the rig has another value. A swap changes
/// only the back end.
Result<std::string> present_backend(const std::string& service, const std::string& word,
                                    config::Rig rig);

}  // namespace handcast::supervisor
