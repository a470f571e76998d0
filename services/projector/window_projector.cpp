// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "renderer/window/window.hpp"
#include "services/projector/light_clock.hpp"

namespace handcast::projector {
namespace {

/// A window as a projector. The light of a frame is assumed `latency_ms` after the window system
/// took it, and in the middle of a refresh.
class WindowProjector final : public Projector {
 public:
  WindowProjector(const config::Projector& settings, int width_px, int height_px,
                  std::unique_ptr<renderer::Window> window)
      : settings_(settings),
        clock_(settings),
        latency_ns_(ms_to_ns(settings.latency_ms)),
        period_ns_(seconds_to_ns(1 / settings.rate_hz)),
        is_packed_(settings.packing != config::Packing::none),
        picture_(width_px, height_px),
        window_(std::move(window)) {}

  Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t,
                               const renderer::LightTable& light, Deadline deadline) override {
    if (!window_->refresh_ns())
      if (auto free = clock_.take(deadline); !free) return free;
    const auto shown = show(frame, light);
    if (!shown) return fail(shown.error().code, "projector 'window': " + shown.error().what);
    if (is_packed_)
      if (auto whole = check_size(); !whole) return tl::make_unexpected(whole.error());
    const auto refresh_ns = window_->refresh_ns();
    if (refresh_ns && !std::exchange(has_compared_, true))
      warn_if_rates_differ(*refresh_ns, settings_);
    return PresentTimes{
        .handed_ns = shown->handed_ns,
        .display_ns = shown->shown_ns + latency_ns_ + refresh_ns.value_or(period_ns_) / 2,
        .note = {msg::LightSource::window,
                 refreshes_.since_last(shown->shown_ns, refresh_ns.value_or(period_ns_))},
        .next_ns = refresh_ns ? shown->shown_ns + *refresh_ns : 0};
  }

  renderer::ShareGroup share_group() const override {
    return is_packed_ ? renderer::ShareGroup() : window_->share_group();
  }

 private:
  Result<renderer::Shown> show(const renderer::Frame& frame, const renderer::LightTable& light) {
    if (frame.device) return window_->show(*frame.device, frame.region, light);
    renderer::write_light(frame.colour, frame.region, light, picture_.view());
    return window_->show(picture_.view(), frame.region);
  }
  /// Sub-frames in the bits or quarters of a frame do not survive that it is scaled.
  Result<void> check_size() const {
    const int width_px = window_->width_px(), height_px = window_->height_px();
    if (width_px == picture_.width() && height_px == picture_.height()) return {};
    return fail(Errc::bad_config,
                fmt::format("projector 'window': its {}x{} pixels must be the {}x{} of the "
                            "calibration, because projector.packing is set: sub-frames cannot be "
                            "scaled",
                            width_px, height_px, picture_.width(), picture_.height()));
  }

  config::Projector settings_;
  LightClock clock_;  ///< the rhythm without that of a monitor
  std::int64_t latency_ns_, period_ns_;
  Refreshes refreshes_;
  bool is_packed_, has_compared_ = false;
  renderer::Texture picture_;
  std::unique_ptr<renderer::Window> window_;
};

[[noreturn]] void end_without_display() {
  log::error("projector 'window': the connection to the display server is lost");
  std::_Exit(kExitRetry);
}

}  // namespace

Result<std::unique_ptr<Projector>> open_window(const config::Rig& rig,
                                               const calib::Calibration& calibration) {
  const auto& settings = rig.projector;
  const int width_px = calibration.projector.width_px, height_px = calibration.projector.height_px;
  auto window = renderer::Window::open({.title = "handcast: " + rig.name,
                                        .width_px = width_px,
                                        .height_px = height_px,
                                        .full_screen = settings.window.full_screen,
                                        .monitor = settings.window.monitor,
                                        .keeps_awake = true,
                                        .vsync = settings.window.vsync,
                                        .when_display_is_lost = end_without_display});
  if (!window) return fail(window.error().code, "projector 'window': " + window.error().what);
  if (const auto monitor = (*window)->monitor())
    if (auto ours = calib::check_device("projector", calibration.projector_device,
                                        {monitor->model, monitor->output});
        !ours)
      return fail_in("projector 'window'", ours.error());
  return std::make_unique<WindowProjector>(settings, width_px, height_px, std::move(*window));
}

}  // namespace handcast::projector
