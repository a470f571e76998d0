// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"

/// Measured settings: a TOML file beside a rig file, which load_rig() applies over it.
/// `handcast calibrate --apply` writes it, so that nothing but its owner writes the rig file.
namespace handcast::config {

/// A setting that was measured.
struct MeasuredSetting {
  std::string path;   ///< "projector.latency_ms"
  std::string value;  ///< as TOML: "10.2", "\"a.toml\""; a file is relative to the rig file

  /// Compares both members.
  bool operator==(const MeasuredSetting&) const = default;
};

/// The file of a rig's measured settings: RIG.measured.toml for RIG.toml.
std::filesystem::path measured_file_of(const std::filesystem::path& rig_file);

/// The settings of such a file in its order, with their values as print_value() writes them. `file`
/// is used in messages. Errors: bad_config, as those of parse_rig().
Result<std::vector<MeasuredSetting>> parse_measured(const std::string& toml,
                                                    const std::filesystem::path& file);

/// The same of a file; none if there is none. Errors: those of read_text() and parse_measured().
Result<std::vector<MeasuredSetting>> read_measured(const std::filesystem::path& file);

/// One line "path = value" for each setting, which parse_measured() reads.
std::string print_measured(std::span<const MeasuredSetting> settings);

}  // namespace handcast::config
