// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/simulate/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "config/sections/sub_frames.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/pipeline/projection.hpp"

namespace handcast::simulate {
namespace {

/// The time from the inputs of a frame to the middle of its light. With sub-frames, the mean: they
/// are drawn one after the other before their output frame is handed over, and lit one after the
/// other afterwards (projector::SubFramePlan).
std::int64_t leg_ns(const config::Projector& projector) {
  const double sub_frames = config::sub_frames_of(projector.packing),
               period_ms = 1e3 / projector.rate_hz;
  const double drawing_ms =
      sub_frames == 1 ? projector.software_ms : std::min(projector.software_ms, period_ms);
  return ms_to_ns(drawing_ms * (sub_frames + 1) / 2 + projector.latency_ms) +
         seconds_to_ns(0.5 * sub_frames / projector.rate_hz);
}

}  // namespace

Simulation::Simulation(const config::Rig& rig, const calib::Calibration& calibration,
                       renderer::Pipeline& pipeline, SensorFeed& feed, int draw_every)
    : rate_hz_(rig.projector.rate_hz),
      leg_ns_(leg_ns(rig.projector)),
      pipeline_(pipeline),
      feed_(feed),
      draw_every_(draw_every),
      looks_(draw_every > 0 && pipeline.looks()),
      image_(calibration.camera.width_px, calibration.camera.height_px),
      projection_(msg::Projection::bytes(calibration.projector_width_px,
                                         calibration.projector_height_px)) {}

std::int64_t Simulation::tick_time_ns(std::int64_t tick) const {
  return static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(tick) / rate_hz_));
}

void Simulation::step(const std::function<void(const Tick&)>& on_tick) {
  const auto now_ns = tick_time_ns(next_tick_);
  const auto lit_ns = now_ns + leg_ns_;
  deliver(now_ns);

  Tick tick{next_tick_, lit_ns, {}, nullptr, nullptr};
  if (draw_every_ > 0 && next_tick_ % draw_every_ == 0) {
    const auto frame = draw(now_ns, lit_ns);
    tick.hands = frame.hands;
    tick.frame = &frame;
    tick.projection = &*projection_;
    on_tick(tick);
  } else {
    if (looks_) pipeline_.look(newest_image(now_ns));
    tick.hands = pipeline_.track(now_ns, lit_ns);
    on_tick(tick);
  }
  ++next_tick_;
}

void Simulation::deliver(std::int64_t now_ns) {
  for (const auto& event : feed_.until(now_ns))
    std::visit([&](const auto& message) { pipeline_.push(event.arrival_ns, message); },
               event.message);
}

renderer::TimedImage Simulation::newest_image(std::int64_t now_ns) {
  const auto newest = feed_.newest_exposure(now_ns);
  if (newest && (!shown_ || shown_->frame_id != newest->frame_id))
    feed_.image(*newest, image_.view());
  shown_ = newest;
  return newest ? renderer::TimedImage{image_.view(), newest->stamp_ns, newest->frame_id}
                : renderer::TimedImage{};
}

renderer::Frame Simulation::draw(std::int64_t now_ns, std::int64_t lit_ns) {
  const auto camera = newest_image(now_ns);
  auto frame = pipeline_.render(now_ns, lit_ns, camera);
  renderer::write_projection(frame, *projection_, projection_.tail_bytes());
  projection_->header.frame_id = static_cast<std::uint64_t>(next_tick_);
  projection_->lit_ns = lit_ns;
  return frame;
}

}  // namespace handcast::simulate
