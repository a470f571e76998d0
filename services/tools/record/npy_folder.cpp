// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/npy_folder.hpp"

#include <fmt/format.h>

#include "ipc/msg/owned.hpp"
#include "renderer/media/picture.hpp"
#include "services/recording/about.hpp"
#include "services/recording/arrays/sensor_arrays.hpp"
#include "services/recording/recording_reader.hpp"

namespace handcast::record {
namespace fs = std::filesystem;
namespace {

using recording::StreamReader;

/// All messages of a stream; none if it was not recorded.
template <class T>
Result<std::vector<T>> read_all(const fs::path& folder, const std::string& stream) {
  const auto about = recording::read_about(folder);
  if (!about) return tl::make_unexpected(about.error());
  std::vector<T> messages;
  if (!about->layouts.contains(stream)) return messages;
  auto reader = StreamReader::open<T>(folder, stream);
  if (!reader) return tl::make_unexpected(reader.error());
  for (std::size_t i = 0; i < reader->rows().size(); ++i)
    if (T message; reader->read(i, message)) messages.push_back(message);
  return messages;
}

/// Writes the images. Returns the times at which they were taken.
Result<std::vector<std::int64_t>> write_images(const fs::path& recording, const fs::path& folder) {
  std::vector<std::int64_t> times_us;
  const auto about = recording::read_about(recording);
  if (!about) return tl::make_unexpected(about.error());
  if (!about->layouts.contains("camera.frames")) return times_us;
  auto reader = StreamReader::open<msg::CameraFrame>(recording, "camera.frames");
  if (!reader) return tl::make_unexpected(reader.error());
  for (std::size_t i = 0; i < reader->rows().size(); ++i) {
    const auto& row = reader->rows()[i];
    renderer::Image<std::uint8_t> image(static_cast<int>(std::min(row.width_px, 16'384u)),
                                        static_cast<int>(std::min(row.height_px, 16'384u)));
    msg::CameraFrame frame;
    if (!reader->read(i, frame, image.pixels())) continue;
    const auto file = folder / fmt::format("{:06}.png", times_us.size());
    if (auto written = renderer::write_png(file, image.view()); !written)
      return tl::make_unexpected(written.error());
    times_us.push_back(recording::to_us(row.origin_ns));
  }
  return times_us;
}

}  // namespace

Result<void> write_npy_folder(const fs::path& recording) {
  auto poses = read_all<msg::HandPoses>(recording, "pose.hands");
  if (!poses) return tl::make_unexpected(poses.error());
  auto landmarks = read_all<msg::Landmarks>(recording, "landmarks.hands");
  if (!landmarks) return tl::make_unexpected(landmarks.error());
  const auto folder = recording / "npy";
  std::error_code failed;
  if (fs::exists(folder, failed))
    return fail(Errc::bad_config,
                fmt::format("{}: it is there already; remove it first", folder.string()));
  fs::create_directories(folder / "camera", failed);
  if (failed)
    return fail(Errc::unavailable,
                fmt::format("{}: cannot be made: {}", folder.string(), failed.message()));
  auto times_us = write_images(recording, folder / "camera");
  if (!times_us) return tl::make_unexpected(times_us.error());
  return recording::write_messages(
      folder, {std::move(*poses), std::move(*landmarks), std::move(*times_us)});
}

}  // namespace handcast::record
