// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/simulation.hpp"

#include "renderer/pipeline/projection.hpp"

namespace handcast::simulate {
Simulation::Simulation(const config::Rig& rig, const calib::Calibration& calibration,
                       renderer::Pipeline& pipeline, SensorFeed& feed, int draw_every)
    : refreshes_(rig.projector, rig.twin.projector, rig.twin.seed),
      pipeline_(pipeline),
      feed_(feed),
      draw_every_(draw_every),
      looks_(draw_every > 0 && pipeline.looks()),
      image_(calibration.camera.width_px, calibration.camera.height_px),
      projection_(
          msg::Projection::bytes(calibration.projector_width_px, calibration.projector_height_px)) {
  pipeline_.show_surface(true);
}

/// The refreshes that show a frame, of those that are to be drawn.
std::vector<std::int64_t> Simulation::drawn_refreshes(std::int64_t frame) {
  std::vector<std::int64_t> refreshes;
  if (draw_every_ <= 0) return refreshes;
  const std::int64_t last = frame + Refreshes::kLongestDelay;
  for (std::int64_t next = (frame + draw_every_ - 1) / draw_every_ * draw_every_;
       next <= last && refreshes_.shown_at(next) <= frame; next += draw_every_)
    if (refreshes_.shown_at(next) == frame) refreshes.push_back(next);
  return refreshes;
}

void Simulation::step(const std::function<void(const Tick&)>& on_tick) {
  const auto now_ns = refreshes_.begin_ns(next_tick_);
  const auto target_ns = refreshes_.display_ns(next_tick_);
  deliver(now_ns);

  Tick tick{.index = next_tick_, .target_ns = target_ns, .display_ns = target_ns};
  if (const auto refreshes = drawn_refreshes(next_tick_); !refreshes.empty()) {
    const auto frame = draw(now_ns, target_ns);
    tick.hands = frame.hands;
    tick.frame = &frame;
    tick.projection = &*projection_;
    for (const std::int64_t refresh : refreshes) {
      tick.display_ns = projection_->lit_ns = refreshes_.display_ns(refresh);
      on_tick(tick);
      tick.is_new = false;
    }
  } else {
    tick.hands =
        pipeline_.track(now_ns, target_ns, looks_ ? newest_image(now_ns) : renderer::TimedImage{});
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

renderer::Frame Simulation::draw(std::int64_t now_ns, std::int64_t target_ns) {
  const auto camera = newest_image(now_ns);
  auto frame = pipeline_.render(now_ns, target_ns, camera);
  renderer::write_projection(frame, *projection_, projection_.tail_bytes());
  projection_->header.frame_id = static_cast<std::uint64_t>(next_tick_);
  return frame;
}

}  // namespace handcast::simulate
