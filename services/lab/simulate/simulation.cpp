// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "config/sections/sub_frames.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/pipeline/projection.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::simulate {
namespace {

/// The time from the inputs of a frame to the middle of its light. With sub-frames, the mean: they
/// are drawn one after the other before their output frame is handed over, and lit one after the
/// other afterwards (projector::SubFramePlan).
std::int64_t leg_ns(const config::Projector& projector, double rate_hz) {
  const double sub_frames = config::sub_frames_of(projector.packing), period_ms = 1e3 / rate_hz;
  const double drawing_ms =
      sub_frames == 1 ? projector.software_ms : std::min(projector.software_ms, period_ms);
  return ms_to_ns(drawing_ms * (sub_frames + 1) / 2 + projector.latency_ms) +
         seconds_to_ns(0.5 * sub_frames / rate_hz);
}

}  // namespace

Refreshes::Refreshes(const config::Projector& projector, const config::TwinProjector& errors,
                     int seed)
    : errors_(errors),
      seed_(seed),
      rate_hz_(projector.rate_hz * (1 + 1e-6 * errors.rate_ppm)),
      software_ms_(projector.software_ms),
      leg_ns_(simulate::leg_ns(projector, rate_hz_)) {}

std::int64_t Refreshes::begin_ns(std::int64_t frame) const {
  return static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(frame) / rate_hz_));
}

double Refreshes::work_ms(std::int64_t frame) const {
  const twin::Random random(seed_, twin::Stream::frame_time);
  const auto k = static_cast<std::uint64_t>(frame);
  const double work_ms = errors_.work_ms * std::exp(errors_.work_spread * random.normal(k, 0));
  return random.uniform(k, 1) < errors_.stalls ? work_ms + errors_.stall_ms : work_ms;
}

/// Begins the next frame, or leaves it out because the one before is not finished. A frame is
/// never shown before one that began earlier: they are drawn one after the other.
void Refreshes::begin_next() {
  const std::int64_t frame = next_++;
  const auto at = static_cast<std::size_t>(frame);
  if (shown_.size() <= at) shown_.push_back(shown_.empty() ? 0 : shown_.back());
  if (begin_ns(frame) < free_ns_) return;
  const double work = work_ms(frame);
  free_ns_ = begin_ns(frame) + ms_to_ns(work);
  const double late = std::ceil((work - software_ms_) * 1e-3 * rate_hz_);
  const auto by = std::clamp(static_cast<std::int64_t>(late), std::int64_t{0}, kLongestDelay);
  while (shown_.size() <= at + static_cast<std::size_t>(by)) shown_.push_back(shown_.back());
  std::fill(shown_.begin() + frame + by, shown_.end(), frame);
}

std::int64_t Refreshes::shown_at(std::int64_t frame) {
  if (errors_.work_ms <= 0) return frame;
  while (next_ <= frame) begin_next();
  return shown_[static_cast<std::size_t>(frame)];
}

Simulation::Simulation(const config::Rig& rig, const calib::Calibration& calibration,
                       renderer::Pipeline& pipeline, SensorFeed& feed, int draw_every)
    : refreshes_(rig.projector, rig.twin.projector, rig.twin.seed),
      pipeline_(pipeline),
      feed_(feed),
      draw_every_(draw_every),
      looks_(draw_every > 0 && pipeline.looks()),
      image_(calibration.camera.width_px, calibration.camera.height_px),
      projection_(
          msg::Projection::bytes(calibration.projector.width_px, calibration.projector.height_px)) {
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

  Tick tick{
      .index = next_tick_, .begin_ns = now_ns, .target_ns = target_ns, .display_ns = target_ns};
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
