// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// A rig as its services read it with --config. Later changes of the user's rig file do not affect
/// services that are restarted.
struct AppliedRig {
  std::string toml;  ///< the text
  UniqueFd file;     ///< the same in a file without a name (memfd), sealed
};
/// Reads a rig file to apply it, with its calibration frozen (config::freeze()): a service that is
/// started again must not read another calibration than the others have. Errors: those of
/// config::load_rig() and config::freeze().
Result<config::Rig> load_rig_to_apply(const std::filesystem::path& rig_file,
                                      const std::vector<std::string>& settings);

/// Stores a rig for its services. Errors: unavailable.
Result<AppliedRig> make_applied(const config::Rig& rig);

/// The applied rig of a supervisor that was started with these arguments and has living services,
/// whether it lives itself or not. Empty if there is none.
std::optional<config::Rig> applied_before(const std::filesystem::path& rig_file,
                                          const std::vector<std::string>& settings);

}  // namespace handcast::supervisor
