// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

/// Live settings that are kept: beside the rig file, which only its owner writes.
namespace handcast::config {

/// The values that a rig starts with: RIG.live.toml for RIG.toml, which load_rig() applies over the
/// measured ones.
std::filesystem::path live_file_of(const std::filesystem::path& rig_file);

/// The file of a preset: RIG.presets/NAME.toml. Errors: bad_config (not a name).
Result<std::filesystem::path> preset_file_of(const std::filesystem::path& rig_file,
                                             std::string_view name);
/// The names of all presets of a rig, sorted.
std::vector<std::string> preset_names(const std::filesystem::path& rig_file);

/// Writes values to a file, as a whole or not at all. Errors: unavailable.
Result<void> write_values(const std::filesystem::path& file, std::string_view values);

}  // namespace handcast::config
