// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/camera/camera.hpp"
#include "services/camera/played_pictures.hpp"
#include "services/camera/read_ahead.hpp"
#include "services/recording/about.hpp"

namespace handcast::camera {
namespace fs = std::filesystem;
namespace {

/// An image that a busy machine could not fetch in time is delivered up to so late.
constexpr std::int64_t kLate_ns = 10'000'000;

/// Plays the images of a recording, at the times at which they were taken or as fast as they are
/// fetched.
class ReplayCamera final : public Camera {
 public:
  ReplayCamera(PlayedPictures pictures, const PlayedAs& as, config::Pace pace)
      : schedule_(std::move(pictures.schedule)),
        as_(as),
        pace_(pace),
        pictures_(std::move(pictures.source), schedule_.count(),
                  static_cast<std::size_t>(as.width_px) * as.height_px, first()) {}

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto room = check_room(as_.width_px, as_.height_px, tail_bytes); !room) return room;
    if (!item_) item_ = next();
    if (!item_ || (pace_ == config::Pace::recorded && item_->due_ns > deadline.time_ns())) {
      const bool is_over = !std::exchange(item_, std::nullopt);
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout,
                  is_over ? "the recording is over" : "no frame before the deadline");
    }
    const auto picture = pictures_.get(item_->number, deadline);
    // One that has not been read yet is asked for again.
    if (!picture && picture.error().code == Errc::timeout)
      return tl::make_unexpected(picture.error());
    const auto item = *std::exchange(item_, std::nullopt);
    last_ns_ = item.due_ns;
    if (!picture) return tl::make_unexpected(picture.error());
    deliver(item, **picture, frame);
    return {};
  }

 private:
  std::optional<recording::Schedule::Item> next() const {
    const auto earliest_ns = last_ns_ + 1;
    return schedule_.at_or_after(
        pace_ == config::Pace::fastest ? earliest_ns : std::max(now_ns() - kLate_ns, earliest_ns));
  }
  std::uint64_t first() const {
    const auto item = next();
    return item ? item->number : 0;
  }
  void deliver(const recording::Schedule::Item& item, const ReadAhead::Picture& picture,
               msg::CameraFrame& frame) const {
    frame = picture.frame;
    std::ranges::copy(picture.pixels, frame.pixels());
    if (pace_ == config::Pace::recorded) sleep_until_ns(item.due_ns);
    frame.header = {item.frame_id, pace_ == config::Pace::recorded ? item.origin_ns : now_ns(), 0};
    frame.width_px = static_cast<std::uint32_t>(as_.width_px);
    frame.height_px = static_cast<std::uint32_t>(as_.height_px);
  }

  recording::Schedule schedule_;
  PlayedAs as_;
  config::Pace pace_;
  std::int64_t last_ns_ = 0;                       ///< when the last image was due
  std::optional<recording::Schedule::Item> item_;  ///< due, but not read yet
  ReadAhead pictures_;
};

Result<PlayedPictures> open_pictures(const fs::path& from, const PlayedAs& as) {
  if (const auto suffix = from.extension(); suffix == ".npy" || suffix == ".NPY")
    return open_npy_pictures(from, as);
  std::error_code failed;
  if (fs::is_regular_file(from, failed)) return open_film_pictures(from, as);
  if (recording::is_recording(from)) return open_recorded_pictures(from, as);
  return open_png_pictures(from, as);
}

}  // namespace

Result<std::unique_ptr<Camera>> open_replay(const Opening& with) {
  const auto& settings = with.settings.replay;
  if (settings.directory.empty())
    return fail(Errc::bad_config, "no recording is given; set replay.directory");
  const PlayedAs as{config::name_at(with.at, "camera.frames"),
                    with.camera.model.width_px,
                    with.camera.model.height_px,
                    with.calibration.id,
                    ms_to_ns(with.settings.exposure_ms),
                    with.settings.rate_hz,
                    with.epoch_ns,
                    settings.loop};
  auto pictures = open_pictures(settings.directory, as);
  if (!pictures) return tl::make_unexpected(pictures.error());
  return std::make_unique<ReplayCamera>(std::move(*pictures), as, settings.pace);
}

}  // namespace handcast::camera
