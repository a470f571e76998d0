#include <algorithm>

#include "services/camera/camera.hpp"
#include "services/camera/frame_size.hpp"
#include "services/camera/pictures.hpp"
#include "services/timing/loop.hpp"
#include "services/twin/recording.hpp"

namespace handcast::camera {
namespace fs = std::filesystem;
namespace {

/// Pictures of a folder, decoded at start-up, played at the times they were taken.
class ReplayCamera final : public Camera {
 public:
  ReplayCamera(std::vector<renderer::Image<std::uint8_t>> pictures, timing::Loop loop, const config::Camera& settings)
      : pictures_(std::move(pictures)), loop_(std::move(loop)), exposure_ns_(ms_to_ns(settings.exposure_ms)) {}

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes, Deadline deadline) override {
    const auto& first = pictures_.front();
    if (auto room = check_room(first.width(), first.height(), tail_bytes); !room) return room;
    const auto item = loop_.at_or_after(std::max(now_ns(), last_ns_ + 1));
    if (!item || item->due_ns > deadline.time_ns()) {
      sleep_until_ns(deadline.time_ns());
      return fail(Errc::timeout, item ? "camera 'replay': no frame before the deadline" : "camera 'replay': the recording is over");
    }
    copy(pictures_[item->index], *item, frame);
    sleep_until_ns(item->due_ns);
    last_ns_ = item->due_ns;
    return {};
  }

 private:
  void copy(const renderer::Image<std::uint8_t>& picture, const timing::Loop::Item& item, msg::CameraFrame& frame) {
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

/// From camera_timestamps.npy (microseconds) where there is one, else at the rig's rate.
Result<std::vector<std::int64_t>> picture_times_ns(const fs::path& folder, std::size_t count, double rate_hz) {
  std::vector<std::int64_t> times_ns;
  const fs::path file = folder / "camera_timestamps.npy";
  if (!fs::exists(file)) {
    for (std::size_t i = 0; i < count; ++i) times_ns.push_back(seconds_to_ns(static_cast<double>(i) / rate_hz));
    return times_ns;
  }
  const auto stamps = twin::read_npy(file);
  if (!stamps) return tl::make_unexpected(stamps.error());
  if (stamps->values.size() != count)
    return fail(Errc::bad_config, fmt::format("'{}' holds {} times for {} pictures", file.string(), stamps->values.size(), count));
  for (const double time_us : stamps->values) times_ns.push_back(static_cast<std::int64_t>(time_us) * 1000);
  return times_ns;
}

}  // namespace

Result<std::unique_ptr<Camera>> open_replay(const config::Rig& rig, const calib::Calibration& calibration, const std::int64_t& epoch_ns) {
  const fs::path folder = rig.camera.replay.directory;
  if (folder.empty()) return fail(Errc::bad_config, "camera 'replay': camera.replay.directory names no folder");
  const fs::path inner = folder / "camera";
  auto pictures = read_pictures(fs::is_directory(inner) ? inner : folder, calibration.camera.width_px, calibration.camera.height_px);
  if (!pictures) return fail_in("camera 'replay'", pictures.error());
  auto times_ns = picture_times_ns(folder, pictures->size(), rig.camera.rate_hz);
  if (!times_ns) return fail_in("camera 'replay'", times_ns.error());
  auto loop = timing::Loop::make(std::move(*times_ns), epoch_ns, rig.camera.replay.loop, seconds_to_ns(1 / rig.camera.rate_hz));
  if (!loop) return fail_in("camera 'replay': camera_timestamps.npy", loop.error());
  return std::make_unique<ReplayCamera>(std::move(*pictures), std::move(*loop), rig.camera);
}

}  // namespace handcast::camera
