// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// The applied rig as a file without a name (memfd), sealed: what the services read with --config.
/// Later changes of the user's rig file do not affect services that are restarted. Errors:
/// unavailable.
Result<UniqueFd> make_applied(const std::string& toml);

/// The applied rig of a supervisor that died and was started with these arguments. Empty if there
/// is none, or if none of its services lives.
std::optional<config::Rig> applied_before(const std::filesystem::path& rig_file,
                                          const std::vector<std::string>& settings);

}  // namespace handcast::supervisor
