// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "services/camera/camera.hpp"
#include "services/runtime/guest_stream.hpp"

namespace handcast::camera {
namespace {

/// The images of a program that is not part of the rig (ipc/client/handcast.h). The first one is
/// black if no program sends yet, so that the rig need not wait for one.
class ExternalCamera final : public Camera {
 public:
  ExternalCamera(service::GuestStream<msg::CameraFrame> guests, int width_px, int height_px)
      : guests_(std::move(guests)),
        width_px_(static_cast<std::uint32_t>(width_px)),
        height_px_(static_cast<std::uint32_t>(height_px)) {}

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto room =
            check_room(static_cast<int>(width_px_), static_cast<int>(height_px_), tail_bytes);
        !room)
      return room;
    const auto sent = guests_.latest(deadline);
    if (!sent && (number_ > 0 || sent.error().code != Errc::timeout))
      return tl::make_unexpected(sent.error());
    if (sent && ((*sent)->width_px != width_px_ || (*sent)->height_px != height_px_))
      return fail(Errc::bad_data,
                  fmt::format("an image of {}x{} px was left out; the calibration "
                              "has {}x{}",
                              (*sent)->width_px, (*sent)->height_px, width_px_, height_px_));
    frame.header = {++number_, sent ? (*sent)->header.origin_ns : now_ns(), 0};
    frame.exposure_ns = sent ? (*sent)->exposure_ns : 0;
    frame.width_px = width_px_;
    frame.height_px = height_px_;
    const auto pixels = std::size_t{width_px_} * height_px_;
    if (sent)
      std::copy_n((*sent)->pixels(), pixels, frame.pixels());
    else
      std::fill_n(frame.pixels(), pixels, std::uint8_t{0});
    return {};
  }

 private:
  service::GuestStream<msg::CameraFrame> guests_;
  std::uint32_t width_px_, height_px_;
  std::uint64_t number_ = 0;
};

}  // namespace

Result<std::unique_ptr<Camera>> open_external(const Opening& with) {
  auto guests = service::GuestStream<msg::CameraFrame>::open(
      with.ring, "guest." + config::name_at(with.at, "camera"), with.settings.process.wait);
  if (!guests) return tl::make_unexpected(guests.error());
  return std::make_unique<ExternalCamera>(std::move(*guests), with.camera.model.width_px,
                                          with.camera.model.height_px);
}

}  // namespace handcast::camera
