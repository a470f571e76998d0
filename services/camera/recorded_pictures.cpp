// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "calib/calibration.hpp"
#include "ipc/base/log.hpp"
#include "services/camera/played_pictures.hpp"
#include "services/recording/about.hpp"

namespace handcast::camera {
namespace {

using recording::StreamReader;

class RecordedPictures final : public PictureSource {
 public:
  explicit RecordedPictures(StreamReader reader) : reader_(std::move(reader)) {}
  Result<void> read(std::size_t index, msg::CameraFrame& frame,
                    std::span<std::uint8_t> pixels) override {
    return reader_.read(index, frame, pixels);
  }

 private:
  StreamReader reader_;
};

/// The images are played all the same: people measure again what they have recorded.
void say_if_calibrated_otherwise(const std::filesystem::path& folder, std::uint32_t ours) {
  const auto file = folder / recording::kCalibrationFile;
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) return;
  const auto recorded = calib::load_calibration(file);
  if (recorded && recorded->id == ours) return;
  log::warning(
      "the images were recorded with another calibration than that of the rig; theirs is '{}' "
      "(calibration)",
      file.string());
}

}  // namespace

Result<PlayedPictures> open_recorded_pictures(const std::filesystem::path& folder,
                                              const PlayedAs& as) {
  auto reader = StreamReader::open<msg::CameraFrame>(
      folder, recording::stream_of(folder, as.stream, "camera.frames"));
  if (!reader) return tl::make_unexpected(reader.error());
  const auto other = std::ranges::find_if(reader->rows(), [&](const auto& row) {
    return !std::cmp_equal(row.width_px, as.width_px) ||
           !std::cmp_equal(row.height_px, as.height_px);
  });
  if (other != reader->rows().end())
    return fail(Errc::bad_config,
                fmt::format("'{}': image {} is {} x {} px, but the calibration "
                            "is for a camera of {} x {} px",
                            folder.string(), other - reader->rows().begin(), other->width_px,
                            other->height_px, as.width_px, as.height_px));
  say_if_calibrated_otherwise(folder, as.calibration);
  auto schedule = recording::Schedule::make(folder, *reader, as.epoch_ns, as.loop);
  if (!schedule) return tl::make_unexpected(schedule.error());
  return PlayedPictures{std::make_unique<RecordedPictures>(std::move(*reader)),
                        std::move(*schedule)};
}

}  // namespace handcast::camera
