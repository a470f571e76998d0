// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"

namespace handcast::supervisor {

/// Writes the rig as it is applied, settings and all, to RIG.toml in the runtime folder: what
/// services read when they are started again. The person's own file may be half edited at that
/// moment; it counts when it is reloaded. Errors: unavailable.
Result<std::filesystem::path> write_applied(const config::Rig& rig);
/// The rig that this very command (file and --set) started and whose services live without their
/// supervisor, as it was applied: a successor goes on with it whatever the file says by now.
std::optional<config::Rig> applied_before(const std::filesystem::path& rig_file,
                                          const std::vector<std::string>& settings);
void forget_applied(const std::string& rig);

}  // namespace handcast::supervisor
