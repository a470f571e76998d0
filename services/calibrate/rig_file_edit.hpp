// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "services/calibrate/session.hpp"

namespace handcast::calibrate {

/// The text of a rig file (TOML) with another value of a setting: in the line that sets it, in a
/// new line of its section, or in a new section at the end. All else stays as it is, comments
/// included. `path`: "projector.latency_ms".
std::string with_setting(const std::string& text, const MeasuredSetting& setting);

/// Writes settings to a rig file; the old one is kept with the time in its name. Returns a sentence
/// about both. Errors: bad_config (the file cannot be read, or would not be a valid rig file:
/// nothing is changed), unavailable (a file cannot be written).
Result<std::string> apply_settings(const std::filesystem::path& rig_file,
                                   std::span<const MeasuredSetting> settings);

}  // namespace handcast::calibrate
