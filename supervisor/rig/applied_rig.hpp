// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"

namespace handcast::supervisor {

/// Writes the applied rig, with all settings, to RIG.toml in the runtime folder. Services read this
/// file at each start: the user's own file, which may be half edited, is read only by `handcast up`
/// and `handcast reload`. Returns the path. Errors: unavailable, bad_config (the folder).
Result<std::filesystem::path> write_applied(const config::Rig& rig);
/// Writes a rig that is to be applied to RIG.next.toml beside the applied file, for replacements of
/// services that are prepared before it is applied. Returns the path. Errors: see write_applied().
Result<std::filesystem::path> write_candidate(const config::Rig& rig);
/// Removes the file written by write_candidate().
void forget_candidate(const std::string& rig);
/// The applied rig of an earlier `handcast up` with the same file and the same --set, if its
/// services live without a supervisor. A successor starts with it, even if the file has changed.
/// Empty if there is none.
std::optional<config::Rig> applied_before(const std::filesystem::path& rig_file,
                                          const std::vector<std::string>& settings);
/// Removes the files written by write_applied() and write_candidate().
void forget_applied(const std::string& rig);

}  // namespace handcast::supervisor
