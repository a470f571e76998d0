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

namespace handcast::twin {

/// A NumPy array file (.npy, format 1-3, little-endian f4 f8 i4 i8, C order), as doubles.
struct Npy {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};
Result<Npy> read_npy(const std::filesystem::path& file);
Result<void> write_npy_f32(const std::filesystem::path& file, const std::vector<std::size_t>& shape,
                           const std::vector<float>& values);
Result<void> write_npy_i64(const std::filesystem::path& file,
                           const std::vector<std::int64_t>& values);

/// The hands of a recording in OpenXR joints, metres.
struct Recording {
  std::int64_t first_ns = 0;          ///< the first sample's time by the recording's clock
  std::vector<std::int64_t> time_ns;  ///< from the first sample
  std::array<std::vector<msg::HandPose>, 2>
      hands;  ///< by side; empty where the recording has no such hand
};

/// Reads timestamps.npy (us) with joints_{left,right}.npy (n,42,3 mm) and bones_{left,right}.npy
/// (n,22,4,4), Leap's layout.
Result<Recording> read_recording(const std::filesystem::path& folder);
/// Writes the same; of a hand that the recording does not have nothing is left in the folder.
Result<void> write_recording(const std::filesystem::path& folder, const Recording& recording);

/// A row of ascending times, microseconds of the recording's clock.
Result<std::vector<std::int64_t>> read_stamps_ns(const std::filesystem::path& file);
/// The times of every sensor of a recording: of timestamps.npy, camera_timestamps.npy and
/// landmarks_timestamps.npy those that are there. Errors: bad_data (a file's), bad_config (times so
/// far apart that they cannot be of one clock).
Result<std::vector<std::vector<std::int64_t>>> read_all_stamps_ns(
    const std::filesystem::path& folder);
/// Removes the arrays and times a recording left in a folder, and no other file.
Result<void> remove_recording(const std::filesystem::path& folder);
/// Errors (bad_config): it may not be looked for.
Result<bool> is_there(const std::filesystem::path& file);

}  // namespace handcast::twin
