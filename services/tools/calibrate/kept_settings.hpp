// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <span>
#include <vector>

#include "services/tools/calibrate/session.hpp"

/// Measured settings in a file of the session, until they are in the rig file.
namespace handcast::calibrate {

/// The settings of a file; none if there is no such file. A file that is none of write_settings()
/// is ignored with a sentence on the standard error.
std::vector<MeasuredSetting> read_settings(const std::filesystem::path& file);

/// Writes numbers as lines "path = value". No settings: removes the file. Errors: unavailable.
Result<void> write_settings(const std::filesystem::path& file,
                            std::span<const MeasuredSetting> settings);

}  // namespace handcast::calibrate
