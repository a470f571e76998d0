// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "ipc/base/log.hpp"
#include "services/camera/aravis/keeper.hpp"
#include "services/camera/aravis/pixels.hpp"
#include "services/camera/camera.hpp"
#include "services/camera/frame_size.hpp"

namespace handcast::camera {
namespace {

/// A GigE Vision or USB3 Vision camera. The images are copied into the slots of the ring: Aravis
/// wants the memory of an image before it begins, and which slot will be free then is not known
/// (DECISIONS.md).
class AravisCamera final : public Camera {
 public:
  AravisCamera(const aravis::Device& device, const config::Camera& settings,
               const calib::PlacedCamera& camera, std::unique_ptr<aravis::Session> session,
               std::shared_ptr<aravis::Mailbox> mailbox)
      : format_(settings.aravis.format),
        width_px_(camera.model.width_px),
        height_px_(camera.model.height_px),
        mailbox_(mailbox),
        keeper_(device, settings, camera, std::move(session), std::move(mailbox)) {}

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto room = check_room(width_px_, height_px_, tail_bytes); !room) return room;
    aravis::Image image;
    if (mailbox_->take(image, deadline)) return copy(image, frame);
    if (const auto trouble = keeper_.trouble()) return tl::make_unexpected(*trouble);
    return fail(Errc::timeout, "no image before the deadline");
  }

 private:
  Result<void> copy(const aravis::Image& image, msg::CameraFrame& frame) const {
    const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
    std::size_t bytes = 0;
    const void* data = arv_buffer_get_data(image.buffer(), &bytes);
    if (!data || bytes < bytes_of(format_, pixels))
      return fail(Errc::bad_data, fmt::format("an image of {} bytes instead of {}", bytes,
                                              bytes_of(format_, pixels)));
    frame.header.frame_id = image.number;
    frame.header.origin_ns = image.exposed_ns;
    frame.exposure_ns = image.exposure_ns;
    frame.origin_error_ns = image.exposed_error_ns;
    frame.lost = image.lost;
    frame.width_px = static_cast<std::uint32_t>(width_px_);
    frame.height_px = static_cast<std::uint32_t>(height_px_);
    to_grey(format_, {static_cast<const std::uint8_t*>(data), bytes}, {frame.pixels(), pixels});
    return {};
  }

  config::PixelFormat format_;
  int width_px_, height_px_;
  std::shared_ptr<aravis::Mailbox> mailbox_;
  aravis::Keeper keeper_;
};

}  // namespace

Result<std::unique_ptr<Camera>> open_aravis(const Opening& with) {
  const auto device = aravis::find_device(with.settings.aravis.device);
  if (!device) return tl::make_unexpected(device.error());
  const auto mailbox = std::make_shared<aravis::Mailbox>(1);
  auto session = aravis::Session::start(*device, with.settings, with.camera, mailbox);
  if (!session) return tl::make_unexpected(session.error());
  const auto& named = (*session)->device();
  const auto& accepted = (*session)->accepted();
  log::info(
      "{} {} {}, {:.1f} Hz, exposure {:.3f} ms{}", named.vendor, named.model, named.serial,
      accepted.rate_hz, accepted.exposure_ms,
      accepted.packet_bytes > 0 ? fmt::format(", packets of {} bytes", accepted.packet_bytes) : "");
  return std::make_unique<AravisCamera>(*device, with.settings, with.camera, std::move(*session),
                                        mailbox);
}

}  // namespace handcast::camera
