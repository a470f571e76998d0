// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/camera/camera.hpp"
#include "services/camera/frame_size.hpp"
#include "services/camera/pictures.hpp"
#include "services/evaluation/twin/recording.hpp"
#include "services/runtime/loop.hpp"

namespace handcast::camera {
namespace fs = std::filesystem;
namespace {

/// Plays the images of a folder at the times at which they were taken. They are decoded at
/// start-up.
class ReplayCamera final : public Camera {
 public:
  ReplayCamera(std::vector<renderer::Image<std::uint8_t>> pictures, timing::Loop loop,
               const config::Camera& settings)
      : pictures_(std::move(pictures)),
        loop_(std::move(loop)),
        exposure_ns_(ms_to_ns(settings.exposure_ms)) {}

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    const auto& first = pictures_.front();
    if (auto room = check_room(first.width(), first.height(), tail_bytes); !room) return room;
    const auto item = loop_.at_or_after(std::max(now_ns(), last_ns_ + 1));
    if (!item || item->due_ns > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, item ? "camera 'replay': no frame before the deadline"
                                      : "camera 'replay': the recording is over");
    }
    copy(pictures_[item->index], *item, frame);
    sleep_until_ns(item->due_ns);
    last_ns_ = item->due_ns;
    return {};
  }

 private:
  void copy(const renderer::Image<std::uint8_t>& picture, const timing::Loop::Item& item,
            msg::CameraFrame& frame) {
    frame.header.frame_id = item.number;
    frame.header.origin_ns = item.due_ns;
    frame.exposure_ns = exposure_ns_;
    frame.width_px = static_cast<std::uint32_t>(picture.width());
    frame.height_px = static_cast<std::uint32_t>(picture.height());
    std::copy(picture.pixels().begin(), picture.pixels().end(), frame.pixels());
  }

  std::vector<renderer::Image<std::uint8_t>> pictures_;
  timing::Loop loop_;
  std::int64_t exposure_ns_;
  std::int64_t last_ns_ = 0;
};

/// The times of the images, from camera_timestamps.npy; if there is no such file, at `rate_hz` from
/// `first_ns` on.
Result<std::vector<std::int64_t>> picture_times_ns(const fs::path& folder, std::size_t count,
                                                   double rate_hz, std::int64_t first_ns) {
  const fs::path file = folder / "camera_timestamps.npy";
  const auto there = twin::is_there(file);
  if (!there) return tl::make_unexpected(there.error());
  if (!*there) {
    std::vector<std::int64_t> times_ns;
    for (std::size_t i = 0; i < count; ++i)
      times_ns.push_back(first_ns + seconds_to_ns(static_cast<double>(i) / rate_hz));
    return times_ns;
  }
  auto times_ns = twin::read_stamps_ns(file);
  if (times_ns && times_ns->size() != count)
    return fail(Errc::bad_config, fmt::format("'{}' has {} times for {} images", file.string(),
                                              times_ns->size(), count));
  return times_ns;
}

}  // namespace

Result<std::unique_ptr<Camera>> open_replay(const config::Rig& rig,
                                            const calib::Calibration& calibration,
                                            const std::int64_t& epoch_ns) {
  const fs::path folder = rig.camera.replay.directory;
  if (folder.empty())
    return fail(Errc::bad_config,
                "camera 'replay': no folder is given; set camera.replay.directory");
  const fs::path inner = folder / "camera";
  const auto has_inner = twin::is_there(inner);
  if (!has_inner) return fail_in("camera 'replay'", has_inner.error());
  auto pictures = read_pictures(*has_inner ? inner : folder, calibration.camera.width_px,
                                calibration.camera.height_px);
  if (!pictures) return fail_in("camera 'replay'", pictures.error());
  const auto stamps_ns = twin::read_all_stamps_ns(folder);
  if (!stamps_ns) return fail_in("camera 'replay'", stamps_ns.error());
  const auto lap = timing::Lap::of(*stamps_ns);
  auto times_ns = picture_times_ns(folder, pictures->size(), rig.camera.rate_hz, lap.first_ns);
  if (!times_ns) return fail_in("camera 'replay'", times_ns.error());
  auto loop = timing::Loop::make(std::move(*times_ns), lap, epoch_ns, rig.camera.replay.loop,
                                 seconds_to_ns(1 / rig.camera.rate_hz));
  if (!loop) return fail_in("camera 'replay': camera_timestamps.npy", loop.error());
  return std::make_unique<ReplayCamera>(std::move(*pictures), std::move(*loop), rig.camera);
}

}  // namespace handcast::camera
