// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "services/tools/calibrate/session.hpp"

namespace handcast::calibrate {

/// The value of a setting in a rig file: the name of a file in quotes.
std::string as_toml(const MeasuredSetting& setting);

/// Writes settings to a rig file, in which all else stays as it is (config::with_value()); the old
/// one is kept with the time in its name. Returns a sentence about both. Errors: bad_config (the
/// file cannot be read or edited, or would not be a valid rig file with these settings; nothing is
/// changed), unavailable (a file cannot be written).
Result<std::string> apply_settings(const std::filesystem::path& rig_file,
                                   std::span<const MeasuredSetting> settings);

}  // namespace handcast::calibrate
