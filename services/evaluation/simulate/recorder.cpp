// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/simulate/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "services/evaluation/simulate/png.hpp"

namespace handcast::simulate {
namespace {

constexpr const char* kSides[] = {"left", "right"};
constexpr std::size_t kColumns = 3;  ///< per landmark: x, y, sigma (px)
constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kStep_ns = 100'000;  ///< shorter than the period of any camera

std::int64_t to_us(std::int64_t time_ns) { return (time_ns + 500) / 1000; }

template <class Message>
std::int64_t origin_us(const Message& message) {
  return to_us(message.header.origin_ns);
}

/// One bit per side: 1 left, 2 right. 0 if a side occurs twice.
template <class Message>
unsigned sides_of(const Message& message) {
  unsigned sides = 0;
  for (std::uint32_t i = 0; i < message.count; ++i) {
    const unsigned side = 1u << static_cast<unsigned>(message.hands[i].side);
    if (sides & side) return 0;
    sides |= side;
  }
  return sides;
}

/// The messages that one recording can hold: those with the most frequent set of hands, in the
/// order of their times, without repeated times.
template <class Message>
std::vector<Message> recordable(std::vector<Message> messages) {
  std::array<std::size_t, 4> of_sides{};
  for (const auto& message : messages) ++of_sides[sides_of(message)];
  const auto most = std::max_element(of_sides.begin() + 1, of_sides.end()) - of_sides.begin();
  std::erase_if(messages, [&](const Message& message) { return sides_of(message) != most; });
  std::ranges::stable_sort(messages, {}, origin_us<Message>);
  const auto same_time = [](const Message& a, const Message& b) {
    return origin_us(a) == origin_us(b);
  };
  messages.erase(std::unique(messages.begin(), messages.end(), same_time), messages.end());
  return messages;
}

Result<void> prepare(const std::filesystem::path& folder) {
  std::error_code failed;
  // If this fails, writing the first picture fails too.
  std::filesystem::create_directories(folder / "camera", failed);
  if (auto removed = twin::remove_recording(folder); !removed) return removed;
  return remove_numbered_pngs(folder / "camera");
}

}  // namespace

RecordingFeed::RecordingFeed(std::unique_ptr<SensorFeed> source, const calib::CameraModel& camera,
                             std::filesystem::path folder)
    : source_(std::move(source)),
      folder_(std::move(folder)),
      image_(camera.width_px, camera.height_px),
      pictures_(prepare(folder_)) {}

std::vector<SensorEvent> RecordingFeed::until(std::int64_t now_ns) {
  auto events = source_->until(now_ns);
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
    source_->image(*newest_, image_.view());
    const auto file = numbered_png(folder_ / "camera", image_times_us_.size());
    if (auto written = write_png(file, std::as_const(image_).view()); !written && pictures_)
      pictures_ = std::move(written);
    image_times_us_.push_back(to_us(newest_->origin_ns));
  }
}

void RecordingFeed::image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) {
  if (!newest_ || newest_->frame_id != exposure.frame_id) return source_->image(exposure, pixels);
  for (int y = 0; y < pixels.height; ++y) std::copy_n(image_.row(y), pixels.width, pixels.row(y));
}

Result<void> RecordingFeed::save() const {
  if (!pictures_) return pictures_;
  twin::Recording recording;
  for (const auto& poses : recordable(poses_)) {
    recording.time_ns.push_back(poses.header.origin_ns);
    for (std::uint32_t i = 0; i < poses.count; ++i)
      recording.hands[static_cast<std::size_t>(poses.hands[i].side)].push_back(poses.hands[i]);
  }
  if (recording.time_ns.size() < 2)
    return fail(Errc::bad_data,
                fmt::format("{}: there is no recording, for there were fewer than two samples of a "
                            "hand",
                            folder_.string()));
  recording.first_ns = recording.time_ns.front();
  for (auto& time_ns : recording.time_ns) time_ns -= recording.first_ns;
  if (auto saved = twin::write_recording(folder_, recording); !saved) return saved;
  if (auto saved = twin::write_npy_i64(folder_ / "camera_timestamps.npy", image_times_us_); !saved)
    return saved;
  return save_landmarks();
}

Result<void> RecordingFeed::save_landmarks() const {
  std::vector<std::int64_t> times_us;
  std::array<std::vector<float>, 2> points;
  for (const auto& seen : recordable(landmarks_)) {
    times_us.push_back(origin_us(seen));
    for (std::uint32_t i = 0; i < seen.count; ++i)
      for (const auto& point : seen.hands[i].points) {
        auto& side = points[static_cast<std::size_t>(seen.hands[i].side)];
        const bool was_seen = point.confidence > 0;
        side.insert(side.end(), {was_seen ? point.x_px : kUnseen, was_seen ? point.y_px : kUnseen,
                                 point.sigma_px});
      }
  }
  for (std::size_t side = 0; side < points.size(); ++side) {
    if (points[side].empty()) continue;
    const auto file = folder_ / fmt::format("landmarks_{}.npy", kSides[side]);
    if (auto saved = twin::write_npy_f32(
            file, {points[side].size() / (kColumns * msg::kLandmarks), msg::kLandmarks, kColumns},
            points[side]);
        !saved)
      return saved;
  }
  return twin::write_npy_i64(folder_ / "landmarks_timestamps.npy", times_us);
}

}  // namespace handcast::simulate
