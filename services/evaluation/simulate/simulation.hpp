// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/owned.hpp"
#include "ipc/msg/projection.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/evaluation/simulate/sensor_feed.hpp"

namespace handcast::simulate {

/// One projector frame of a simulated rig. Borrowed: valid during the call it is given to.
struct Tick {
  std::int64_t index = 0;   ///< of the projector frame
  std::int64_t lit_ns = 0;  ///< the middle of the time its light is on
  std::span<const renderer::FrameHand> hands;
  const renderer::Frame* frame = nullptr;       ///< null where the frame was tracked, not drawn
  const msg::Projection* projection = nullptr;  ///< null likewise
};

/// The cascade in virtual time: at each projector frame, what has arrived goes in; what is drawn is
/// lit `software_ms` and the projector's latency later. Every `draw_every`-th frame is drawn, the
/// others only tracked, which leaves the cascade's memory as if all were; with 0 none is drawn.
class Simulation {
 public:
  Simulation(const config::Rig& rig, const calib::Calibration& calibration,
             renderer::Pipeline& pipeline, SensorFeed& feed, int draw_every);

  /// Runs the next projector frame.
  void step(const std::function<void(const Tick&)>& on_tick);

  std::int64_t now_ns() const { return tick_time_ns(next_tick_); }

 private:
  std::int64_t tick_time_ns(std::int64_t tick) const;
  void deliver(std::int64_t now_ns);
  renderer::TimedImage newest_image(std::int64_t now_ns);
  renderer::Frame draw(std::int64_t now_ns, std::int64_t lit_ns);

  double rate_hz_;
  std::int64_t leg_ns_;  ///< from the start of a frame to the middle of its light
  renderer::Pipeline& pipeline_;
  SensorFeed& feed_;
  int draw_every_;
  bool looks_;  ///< at every image, of frames that are not drawn too
  std::int64_t next_tick_ = 0;
  std::optional<Exposure> shown_;
  renderer::Image<std::uint8_t> image_;
  msg::Owned<msg::Projection> projection_;
};

}  // namespace handcast::simulate
