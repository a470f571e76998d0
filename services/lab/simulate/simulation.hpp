// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "config/sections/projector.hpp"
#include "config/sections/twin/projector.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/owned.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/lab/simulate/sensor_feed.hpp"

namespace handcast::simulate {

/// The refreshes of a simulated projector, and which frame each of them shows. A frame begins with
/// every refresh, if the one before is finished by then; its light is on `leg_ns()` later if it is
/// finished within projector.software_ms, otherwise with the first refresh after that. Until then
/// the light of an earlier frame stays on. One thread.
class Refreshes {
 public:
  /// `seed` selects the times that frames take.
  Refreshes(const config::Projector& projector, const config::TwinProjector& errors, int seed);

  /// The beginning of a frame, ns since the epoch.
  std::int64_t begin_ns(std::int64_t frame) const;
  /// The middle of the light for which a frame is drawn.
  std::int64_t display_ns(std::int64_t frame) const { return begin_ns(frame) + leg_ns_; }
  /// The most refreshes that a frame can be late.
  static constexpr std::int64_t kLongestDelay = 64;
  /// The frame whose light is on at display_ns(frame): this one, or an earlier one.
  std::int64_t shown_at(std::int64_t frame);

 private:
  double work_ms(std::int64_t frame) const;
  void begin_next();

  config::TwinProjector errors_;
  int seed_;
  double rate_hz_, software_ms_;
  std::int64_t leg_ns_;
  /// The frame that each refresh shows, as far as frames have begun. Refreshes that no frame has
  /// reached yet show the newest before them.
  std::vector<std::int64_t> shown_;
  std::int64_t next_ = 0;     ///< the frame that begins next
  std::int64_t free_ns_ = 0;  ///< when the frame before it is finished
};

/// One projector frame of a simulated rig. The borrowed data is valid during the callback only.
struct Tick {
  std::int64_t index = 0;       ///< number of the projector frame
  std::int64_t begin_ns = 0;    ///< when it begins
  std::int64_t target_ns = 0;   ///< the middle of the light for which it was computed
  std::int64_t display_ns = 0;  ///< the middle of a light that shows it: later, if it was late
  bool is_new = true;           ///< false from the second drawn refresh on that shows it
  std::span<const renderer::FrameHand> hands;   ///< the tracked hands
  const renderer::Frame* frame = nullptr;       ///< null if the frame was tracked but not drawn
  const msg::Projection* projection = nullptr;  ///< null if the frame was not drawn
};

/// Runs the cascade in virtual time. Each projector frame uses the messages and images that have
/// arrived when it begins; Refreshes says when it is shown. The frames that every `draw_every`-th
/// refresh shows are drawn. The others are only tracked, which leaves the cascade in the
/// same state as if they had been drawn. With 0 no frame is drawn.
class Simulation {
 public:
  /// The pipeline and the feed must outlive the simulation.
  Simulation(const config::Rig& rig, const calib::Calibration& calibration,
             renderer::Pipeline& pipeline, SensorFeed& feed, int draw_every);

  /// Runs the next projector frame and calls `on_tick` with it; a drawn frame, once for each drawn
  /// refresh that shows it.
  void step(const std::function<void(const Tick&)>& on_tick);

  /// The time at which the next projector frame begins, since the epoch.
  std::int64_t now_ns() const { return refreshes_.begin_ns(next_tick_); }

 private:
  std::vector<std::int64_t> drawn_refreshes(std::int64_t frame);
  void deliver(std::int64_t now_ns);
  renderer::TimedImage newest_image(std::int64_t now_ns);
  renderer::Frame draw(std::int64_t now_ns, std::int64_t target_ns);

  Refreshes refreshes_;
  renderer::Pipeline& pipeline_;
  SensorFeed& feed_;
  int draw_every_;
  bool looks_;  ///< the pipeline needs the image of each frame, drawn or not
  std::int64_t next_tick_ = 0;
  std::optional<Exposure> shown_;
  renderer::Image<std::uint8_t> image_;
  msg::Owned<msg::Projection> projection_;
};

}  // namespace handcast::simulate
