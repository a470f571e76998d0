// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"

namespace handcast::supervisor {

/// Writes the rig as it is applied, with all settings, to RIG.toml in the runtime folder. Services
/// read that file whenever they are started; the person's own file may be half edited at that
/// moment and counts only when it is reloaded. Returns the path. Errors: unavailable, bad_config
/// (the folder).
Result<std::filesystem::path> write_applied(const config::Rig& rig);
/// The applied rig that the same command (file and --set) has started, if its services live without
/// a supervisor: a successor goes on with it, whatever the file says by now.
std::optional<config::Rig> applied_before(const std::filesystem::path& rig_file,
                                          const std::vector<std::string>& settings);
/// Removes the file.
void forget_applied(const std::string& rig);

}  // namespace handcast::supervisor
