// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/clock.hpp"
#include "renderer/kms/screen.hpp"
#include "services/projector/light_clock.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {
namespace {

/// A display without a window system as a projector. The light of a frame comes `latency_ms` after
/// the refresh at which the card showed it, and is meant for the middle of a refresh.
class KmsProjector final : public Projector {
 public:
  KmsProjector(const config::Projector& settings, int width_px, int height_px,
               std::unique_ptr<renderer::kms::Screen> screen)
      : latency_ns_(ms_to_ns(settings.latency_ms)),
        picture_(width_px, height_px),
        screen_(std::move(screen)) {}

  Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t,
                               const renderer::LightTable& light, Deadline deadline) override {
    renderer::write_light(frame.colour, frame.region, light, picture_.view());
    const auto flip = screen_->show(picture_.view(), frame.region, deadline);
    if (!flip) return fail_in("projector 'kms'", flip.error());
    return PresentTimes{.handed_ns = flip->handed_ns,
                        .display_ns = flip->flip_ns + latency_ns_ + screen_->refresh_ns() / 2,
                        .note = {msg::LightSource::kernel, flip->refreshes},
                        .next_ns = flip->flip_ns + screen_->refresh_ns()};
  }

 private:
  std::int64_t latency_ns_;
  renderer::Texture picture_;
  std::unique_ptr<renderer::kms::Screen> screen_;
};

}  // namespace

Result<std::unique_ptr<Projector>> open_kms(const config::Rig& rig,
                                            const calib::Calibration& calibration) {
  const auto& settings = rig.projector;
  const int width_px = calibration.projector.width_px, height_px = calibration.projector.height_px;
  auto screen =
      renderer::kms::Screen::open({.card = settings.kms.card,
                                   .connector = settings.kms.connector,
                                   .mode = settings.kms.mode,
                                   .width_px = width_px,
                                   .height_px = height_px,
                                   .rate_hz = settings.rate_hz,
                                   .may_scale = settings.packing == config::Packing::none});
  if (!screen) return fail_in("projector 'kms'", screen.error());
  const auto& display = (*screen)->display();
  if (auto ours = calib::check_device("projector", calibration.projector_device,
                                      {display.model, display.connector});
      !ours)
    return fail_in("projector 'kms'", ours.error());
  warn_if_rates_differ((*screen)->refresh_ns(), settings);
  return std::make_unique<KmsProjector>(settings, width_px, height_px, std::move(*screen));
}

}  // namespace handcast::projector
