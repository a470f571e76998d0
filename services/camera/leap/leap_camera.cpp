// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/log.hpp"
#include "services/camera/camera.hpp"
#include "services/camera/frame_size.hpp"
#include "services/camera/leap/bring_up.hpp"
#include "services/camera/leap/deinterleave.hpp"
#include "services/camera/leap/keeper.hpp"

namespace handcast::camera {
namespace {

/// A Leap Motion Controller as a stereo camera.
class LeapCamera final : public Camera {
 public:
  LeapCamera(const config::Camera& settings, const calib::PlacedCamera& camera,
             std::unique_ptr<leap::Session> session, std::shared_ptr<leap::Mailbox> mailbox)
      : eye_(settings.leap.eye == config::Eye::left ? 0 : 1),
        width_px_(camera.model.width_px),
        height_px_(camera.model.height_px),
        exposure_ns_(ms_to_ns(settings.exposure_ms)),
        mailbox_(mailbox),
        keeper_(settings, camera, std::move(session), std::move(mailbox)) {}

  bool has_second_image() const override { return true; }

  Result<void> capture(msg::CameraFrame& frame, std::size_t tail_bytes,
                       Deadline deadline) override {
    if (auto taken = take(tail_bytes, deadline); !taken) return taken;
    write(eye_, frame);
    return {};
  }

  Result<void> capture_both(msg::CameraFrame& frame, msg::CameraFrame& second,
                            std::size_t tail_bytes, Deadline deadline) override {
    if (auto taken = take(tail_bytes, deadline); !taken) return taken;
    write(eye_, frame);
    write(1 - eye_, second);
    return {};
  }

 private:
  Result<void> take(std::size_t tail_bytes, Deadline deadline) {
    if (auto room = check_room(width_px_, height_px_, tail_bytes); !room) return room;
    if (mailbox_->take(image_, deadline)) return {};
    if (const auto trouble = keeper_.trouble()) return tl::make_unexpected(*trouble);
    return fail(Errc::timeout, "no image before the deadline");
  }

  void write(std::size_t eye, msg::CameraFrame& frame) const {
    frame.header.frame_id = image_.number;
    frame.header.origin_ns = image_.exposed_ns;
    frame.exposure_ns = exposure_ns_;
    frame.origin_error_ns = image_.exposed_error_ns;
    frame.lost = image_.lost;
    frame.width_px = static_cast<std::uint32_t>(width_px_);
    frame.height_px = static_cast<std::uint32_t>(height_px_);
    const auto pixels = static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_);
    leap::deinterleave(image_.bytes, eye, width_px_, {frame.pixels(), pixels});
  }

  std::size_t eye_;  ///< whose images go to the first message: 0 left, 1 right
  int width_px_, height_px_;
  std::int64_t exposure_ns_;
  leap::StereoImage image_;
  std::shared_ptr<leap::Mailbox> mailbox_;
  leap::Keeper keeper_;
};

void report(const leap::Session& session, double asked_hz) {
  const auto& mode = session.mode();
  const auto text =
      fmt::format("{} sends {}x{} of both eyes", session.name(), mode.width_px, mode.height_px);
  if (std::abs(mode.rate_hz - asked_hz) < 0.01 * asked_hz)
    return log::info("{} at {:.4g} Hz", text, mode.rate_hz);
  log::warning("{} at {:.4g} Hz instead of {:g} Hz (rate_hz)", text, mode.rate_hz, asked_hz);
}

}  // namespace

Result<std::unique_ptr<Camera>> open_leap(const Opening& with) {
  const auto& settings = with.settings;
  // Numbers go on over restarts of the service; the rate is at most 250 Hz.
  constexpr std::int64_t kShortestPeriod_ns = 4'000'000;
  const auto first = static_cast<std::uint64_t>(
      std::max<std::int64_t>(now_ns() - with.epoch_ns, 0) / kShortestPeriod_ns);
  const auto mailbox = std::make_shared<leap::Mailbox>(first);
  auto session = leap::Session::start(settings.leap.device, settings, with.camera, mailbox, false);
  if (!session) return tl::make_unexpected(session.error());
  report(**session, settings.rate_hz);
  return std::make_unique<LeapCamera>(settings, with.camera, std::move(*session), mailbox);
}

Result<void> check_leap(const Opening& with) {
  const auto steps = leap::load_bring_up(with.settings.leap.bring_up);
  if (!steps) return fail_in("leap.bring_up", steps.error());
  return {};
}

}  // namespace handcast::camera
