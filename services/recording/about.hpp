// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

/// recording.json, which says what the other files of a recording hold.
namespace handcast::recording {

inline constexpr std::string_view kAboutFile = "recording.json";
/// The calibration of the rig that was recorded; its rig.toml refers to it.
inline constexpr std::string_view kCalibrationFile = "calibration.toml";

/// The file of a recording of these streams, which have a type (streams.hpp).
std::string about_text(const std::string& rig, const std::vector<std::string>& streams);

/// What a reader checks.
struct About {
  std::string rig;                             ///< name of the rig
  std::map<std::string, std::string> layouts;  ///< T::layout of each stream
};

/// Reads it. Errors: bad_config (there is no such file; a newer version of handcast wrote it),
/// bad_data (it is damaged).
Result<About> read_about(const std::filesystem::path& folder);

/// True if the folder is a recording of `handcast record`.
bool is_recording(const std::filesystem::path& folder);

/// The stream of a recording that plays as `wanted`: this one, or `otherwise` if the recording does
/// not have it. A second camera may have been recorded alone, as the only one of its rig.
std::string stream_of(const std::filesystem::path& folder, std::string wanted,
                      std::string otherwise);

/// Errors: bad_config (there is no such folder).
Result<void> check_folder(const std::filesystem::path& folder);

}  // namespace handcast::recording
