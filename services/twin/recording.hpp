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
Result<void> write_npy_f32(const std::filesystem::path& file, const std::vector<std::size_t>& shape, const std::vector<float>& values);
Result<void> write_npy_i64(const std::filesystem::path& file, const std::vector<std::int64_t>& values);

/// The hands of a recording in OpenXR joints, metres; sample times from its first sample.
struct Recording {
  std::vector<std::int64_t> time_ns;
  std::array<std::vector<msg::HandPose>, 2> hands;  ///< by side; empty where the recording has no such hand
};

/// Reads timestamps.npy (us) with joints_{left,right}.npy (n,42,3 mm) and bones_{left,right}.npy (n,22,4,4), Leap's layout.
Result<Recording> read_recording(const std::filesystem::path& folder);
/// Writes the same.
Result<void> write_recording(const std::filesystem::path& folder, const Recording& recording);

}  // namespace handcast::twin
