// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "ipc/base/log.hpp"
#include "services/camera/camera.hpp"
#include "services/camera/v4l2/controls.hpp"
#include "services/camera/v4l2/convert.hpp"
#include "services/camera/v4l2/exposure.hpp"
#include "services/camera/v4l2/loss_count.hpp"
#include "services/camera/v4l2/mode.hpp"
#include "services/camera/v4l2/stream.hpp"

namespace handcast::camera::v4l2 {
namespace {

/// An image and its number.
struct Numbered {
  Filled image;
  std::uint64_t number = 0;
};

Result<std::vector<Numbered>> take_all(Stream& stream, LossCount& losses) {
  std::vector<Numbered> images;
  while (images.size() < stream.buffers()) {
    const auto image = stream.take();
    if (!image) return tl::make_unexpected(image.error());
    if (!*image) return images;
    images.push_back({**image, losses.arrived((*image)->sequence)});
  }
  losses.all_were_full();
  return images;
}

/// Takes everything from a stream and gives all but the newest image back. Broken images are
/// dropped. If all buffers were full, even the newest image may be old, because the driver had no
/// buffer for those after it: all are dropped. Empty if no image is left. Errors: disconnected.
Result<std::optional<Numbered>> take_newest(Stream& stream, LossCount& losses) {
  const auto images = take_all(stream, losses);
  if (!images) return tl::make_unexpected(images.error());
  const bool is_late = images->size() == stream.buffers();
  std::optional<Numbered> newest;
  for (const auto& one : *images) {
    const bool is_broken = one.image.is_broken || one.image.bytes.empty();
    const bool is_dropped = is_broken || is_late;
    if (is_broken) losses.incomplete();
    if ((!is_broken && is_late) || (!is_dropped && newest)) losses.skipped();
    const auto* given = is_dropped ? &one : newest ? &*newest : nullptr;
    if (given != nullptr)
      if (auto done = stream.give_back(given->image); !done)
        return tl::make_unexpected(done.error());
    if (!is_dropped) newest = one;
  }
  return newest;
}

}  // namespace

}  // namespace handcast::camera::v4l2

namespace handcast::camera {
namespace {

using namespace v4l2;

/// Without a whole image for this long, the camera is taken for lost. The first one may take
/// longer: cameras start slowly.
/// @{
constexpr std::int64_t kSilence_ns = 1'000'000'000, kFirstSilence_ns = 5'000'000'000;
constexpr std::int64_t kSilentPeriods = 10;  ///< if that is longer
/// @}

/// A webcam, by the kernel's own interface (Video4Linux).
class V4l2Camera final : public Camera {
 public:
  V4l2Camera(std::unique_ptr<Device> device, std::unique_ptr<Stream> stream, const Layout& layout,
             const StreamTimes& times, std::uint64_t first_id)
      : device_(std::move(device)),
        stream_(std::move(stream)),
        layout_(layout),
        times_(times),
        losses_(first_id),
        silent_at_ns_(now_ns() + kFirstSilence_ns) {}

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto room = check_room(layout_.width_px, layout_.height_px, tail_bytes); !room) return room;
    forgive_absence();
    const auto newest = wait_for_newest(deadline);
    if (!newest) return tl::make_unexpected(newest.error());
    auto written = write(*newest, frame);
    if (auto done = stream_->give_back(newest->image); !done) return done;
    return written;
  }

 private:
  Result<Numbered> wait_for_newest(Deadline deadline) {
    for (;;) {
      const auto newest = take_newest(*stream_, losses_);
      if (!newest) return tl::make_unexpected(newest.error());
      if (*newest) return **newest;
      if (auto ready = stream_->wait(deadline); !ready)
        return tl::make_unexpected(gone_or(ready.error()));
    }
  }

  std::int64_t silence_ns() const {
    return std::max(kSilence_ns, kSilentPeriods * times_.period_ns);
  }

  /// While the service did not ask for images, silence says nothing about the camera.
  void forgive_absence() {
    const std::int64_t called_ns = now_ns();
    if (called_ns - std::exchange(last_call_ns_, called_ns) > kSilence_ns / 2)
      silent_at_ns_ = std::max(silent_at_ns_, called_ns + silence_ns());
  }

  /// A timeout is an error of its own if no image has come for long.
  Error gone_or(const Error& error) const {
    if (error.code != Errc::timeout || now_ns() < silent_at_ns_) return error;
    return {Errc::disconnected,
            fmt::format("{} sends no more whole images", describe(device_->identity))};
  }

  Result<void> write(const Numbered& numbered, msg::CameraFrame& frame) {
    const auto& image = numbered.image;
    silent_at_ns_ = now_ns() + silence_ns();
    say_if_unstamped(image.times);
    const auto origin = origin_of(image.times, times_);
    const auto pixels = static_cast<std::size_t>(layout_.width_px) * layout_.height_px;
    auto converted = to_grey(layout_, image.bytes, {frame.pixels(), pixels});
    if (converted && origin.time_ns <= last_origin_ns_)
      converted = fail(Errc::bad_data, "an image is as old as the one before it");
    if (!converted) {
      losses_.incomplete();
      return converted;
    }
    last_origin_ns_ = origin.time_ns;
    frame.header.frame_id = numbered.number;
    frame.header.origin_ns = origin.time_ns;
    frame.origin_error_ns = origin.error_ns;
    frame.exposure_ns = times_.exposure.time_ns;
    frame.lost = losses_.take();
    frame.width_px = static_cast<std::uint32_t>(layout_.width_px);
    frame.height_px = static_cast<std::uint32_t>(layout_.height_px);
    return {};
  }

  void say_if_unstamped(const ImageTimes& times) {
    if (std::exchange(has_said_, true) || times.stamp_of != StampOf::nothing) return;
    log::warning(
        "the driver stamps images with another clock than CLOCK_MONOTONIC; their times are those "
        "of their arrival, less delivery_ms");
  }

  std::unique_ptr<Device> device_;  ///< the stream refers to it
  std::unique_ptr<Stream> stream_;
  Layout layout_;
  StreamTimes times_;
  LossCount losses_;
  std::int64_t silent_at_ns_;  ///< the camera is lost if there is no image until then
  std::int64_t last_call_ns_ = now_ns();
  std::int64_t last_origin_ns_ = 0;
  bool has_said_ = false;
};

/// Reports what the camera holds.
void report(const Device& device, const Mode& mode, double asked_hz) {
  const auto text =
      fmt::format("{} sends {} {}x{}", describe(device.identity), word_of(mode.layout.format),
                  mode.layout.width_px, mode.layout.height_px);
  if (mode.rate_hz <= 0) return log::warning("{}; its driver does not say at which rate", text);
  if (std::abs(mode.rate_hz - asked_hz) < 0.01 * asked_hz)
    return log::info("{} at {:.4g} Hz", text, mode.rate_hz);
  log::warning("{} at {:.4g} Hz instead of {:g} Hz (rate_hz)", text, mode.rate_hz, asked_hz);
}

Result<Mode> configure(const Device& device, const config::Camera& settings, Size size) {
  auto mode = set_mode(device, settings.v4l2.format, size, settings.rate_hz);
  if (!mode) return mode;
  if (auto exposed = set_exposure(device, settings.exposure_ms); !exposed)
    return tl::make_unexpected(exposed.error());
  if (auto set = set_controls(device, settings.v4l2.controls); !set)
    return tl::make_unexpected(set.error());
  report(device, *mode, settings.rate_hz);
  return mode;
}

}  // namespace

Result<std::unique_ptr<Camera>> open_v4l2(const Opening& with) {
  const auto& settings = with.settings;
  auto found = find_device(settings.v4l2.device);
  if (!found) return tl::make_unexpected(found.error());
  auto device = std::make_unique<Device>(std::move(*found));
  const auto& identity = device->identity;
  if (auto ours = calib::check_device("camera", with.camera.device,
                                      {identity.card, identity.bus, identity.path});
      !ours)
    return tl::make_unexpected(ours.error());
  const auto& model = with.camera.model;
  const auto mode = configure(*device, settings, {model.width_px, model.height_px});
  if (!mode) return tl::make_unexpected(mode.error());
  const double rate_hz = mode->rate_hz > 0 ? mode->rate_hz : settings.rate_hz;
  const StreamTimes times{.exposure = held_exposure(device->fd.get(), settings.exposure_ms),
                          .delivery_ns = ms_to_ns(settings.delivery_ms),
                          .period_ns = seconds_to_ns(1 / rate_hz)};
  auto stream = Stream::start(*device);
  if (!stream) return tl::make_unexpected(stream.error());
  // Numbers go on over restarts of the service.
  const auto first_id = static_cast<std::uint64_t>(
      std::max<std::int64_t>(now_ns() - with.epoch_ns, 0) / times.period_ns);
  return std::make_unique<V4l2Camera>(std::move(device), std::move(*stream), mode->layout, times,
                                      first_id);
}

}  // namespace handcast::camera
