// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/recording/arrays/npy.hpp"

namespace handcast::recording {

/// The hands of a recording in OpenXR joints, metres.
struct RecordedHands {
  std::int64_t first_ns = 0;          ///< time of the first sample by the recording's clock
  std::vector<std::int64_t> time_ns;  ///< times of the samples since the first
  /// The poses by side, one per time; empty if the hand was not recorded.
  std::array<std::vector<msg::HandPose>, 2> hands;
};

/// Reads timestamps.npy (us), joints_{left,right}.npy (n,42,3 mm) and bones_{left,right}.npy
/// (n,22,4,4), all in Leap's layout. Of samples of one time all but the first are left out, with a
/// warning. Errors: bad_config (a file is missing, or there is no hand),
/// bad_data (a malformed file; fewer than two or more than 100,000 times; lengths or times that are
/// not in the unit of the layout).
Result<RecordedHands> read_recording(const std::filesystem::path& folder);
/// Writes the same files, and removes those of a hand that is not in the recording. Errors:
/// unavailable (a file cannot be written or removed), bad_data (a hand without a pose per time).
Result<void> write_recording(const std::filesystem::path& folder, const RecordedHands& recording);

/// Reads an array of ascending times in microseconds of the recording's clock. Errors: as read_npy,
/// and bad_data (more than 10,000,000 times; a time out of range or not later than the one before
/// it; steps that no sensor has, because the unit is another).
Result<std::vector<std::int64_t>> read_stamps_ns(const std::filesystem::path& file);
/// The times of each sensor of a recording, from those of timestamps.npy, camera_timestamps.npy and
/// landmarks_timestamps.npy that exist. Errors: as read_stamps_ns, and bad_config (times more than
/// an hour apart, which cannot be of one clock).
Result<std::vector<std::vector<std::int64_t>>> read_all_stamps_ns(
    const std::filesystem::path& folder);
/// Removes the arrays and time stamps of a recording from a folder, and no other file. Errors:
/// unavailable (a file cannot be removed).
Result<void> remove_recording(const std::filesystem::path& folder);
/// Whether a file exists. Errors: bad_config (its status cannot be read).
Result<bool> is_there(const std::filesystem::path& file);

}  // namespace handcast::recording
