// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::recording {

/// The messages of the sensors of a rig, and the times of its camera's images.
struct SensorMessages {
  std::vector<msg::HandPoses> poses;
  std::vector<msg::Landmarks> landmarks;
  std::vector<std::int64_t> image_times_us;
};

/// Nanoseconds to microseconds, rounded.
constexpr std::int64_t to_us(std::int64_t time_ns) { return (time_ns + 500) / 1000; }

/// Writes messages as a recording in Leap's layout: timestamps.npy, joints_SIDE.npy and
/// bones_SIDE.npy; landmarks_timestamps.npy and landmarks_SIDE.npy (n,21,3: x, y and sigma in px; x
/// and y are NaN if the landmark was not seen); camera_timestamps.npy. Times are in microseconds.
/// All samples of a recording hold the same hands: those with other hands than most are left out.
/// Errors: unavailable (a file cannot be written), bad_data (fewer than two samples of a hand; the
/// times of the images are written all the same).
Result<void> write_messages(const std::filesystem::path& folder, const SensorMessages& messages);

}  // namespace handcast::recording
