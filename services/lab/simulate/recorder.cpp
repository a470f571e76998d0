// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "renderer/media/picture.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::simulate {
namespace {

bool is_numbered_png(const std::filesystem::path& file) {
  const auto stem = file.stem().string();
  return file.extension() == ".png" && stem.size() == 6 &&
         stem.find_first_not_of("0123456789") == std::string::npos;
}

constexpr std::int64_t kStep_ns = 100'000;  ///< shorter than the period of any camera

Result<void> prepare(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder / "camera", failed);
  if (failed)
    return fail(Errc::bad_config,
                fmt::format("{}: the folder of the recording cannot be created: {}",
                            (folder / "camera").string(), failed.message()));
  if (auto removed = recording::remove_recording(folder); !removed) return removed;
  return remove_numbered_pngs(folder / "camera");
}

}  // namespace

std::filesystem::path numbered_png(const std::filesystem::path& folder, std::size_t number) {
  return folder / fmt::format("{:06}.png", number);
}

Result<void> remove_numbered_pngs(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed))
    if (is_numbered_png(entry->path())) files.push_back(entry->path());
  for (const auto& file : files)
    if (std::filesystem::remove(file, failed); failed)
      return fail(Errc::bad_config,
                  fmt::format("{}: cannot be removed: {}", file.string(), failed.message()));
  return {};
}

RecordingFeed::RecordingFeed(std::unique_ptr<SensorFeed> source, const calib::CameraModel& camera,
                             std::filesystem::path folder)
    : source_(std::move(source)),
      folder_(std::move(folder)),
      image_(camera.width_px, camera.height_px) {}

Result<std::unique_ptr<RecordingFeed>> RecordingFeed::create(std::unique_ptr<SensorFeed> source,
                                                             const calib::CameraModel& camera,
                                                             std::filesystem::path folder) {
  if (auto prepared = prepare(folder); !prepared) return tl::make_unexpected(prepared.error());
  return std::unique_ptr<RecordingFeed>(
      new RecordingFeed(std::move(source), camera, std::move(folder)));
}

std::vector<SensorEvent> RecordingFeed::until(std::int64_t now_ns) {
  auto events = source_->until(now_ns);
  events_.insert(events_.end(), events.begin(), events.end());
  for (const auto& event : events)
    std::visit([this](const auto& message) { keep(message); }, event.message);
  keep_images(now_ns);
  return events;
}

void RecordingFeed::keep_images(std::int64_t now_ns) {
  while (asked_ns_ < now_ns) {
    asked_ns_ = std::min(asked_ns_ + kStep_ns, now_ns);
    const auto newest = source_->newest_exposure(asked_ns_);
    if (!newest || (newest_ && newest->frame_id == newest_->frame_id)) continue;
    newest_ = newest;
    exposures_.push_back(*newest);
    source_->image(*newest_, image_.view());
    const auto file = numbered_png(folder_ / "camera", image_times_us_.size());
    if (auto written = renderer::write_png(file, std::as_const(image_).view());
        !written && pictures_)
      pictures_ = std::move(written);
    image_times_us_.push_back(recording::to_us(newest_->stamp_ns));
  }
}

void RecordingFeed::image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) {
  if (!newest_ || newest_->frame_id != exposure.frame_id) return source_->image(exposure, pixels);
  for (int y = 0; y < pixels.height; ++y) std::copy_n(image_.row(y), pixels.width, pixels.row(y));
}

Result<void> RecordingFeed::save() const {
  if (!pictures_) return pictures_;
  return recording::write_messages(folder_, {poses_, landmarks_, image_times_us_});
}

}  // namespace handcast::simulate
