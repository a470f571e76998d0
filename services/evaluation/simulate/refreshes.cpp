// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/simulate/refreshes.hpp"

#include <algorithm>
#include <cmath>

#include "config/sections/sub_frames.hpp"
#include "ipc/base/clock.hpp"
#include "services/evaluation/twin/random.hpp"

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

/// The number of refreshes that a frame is late.
std::int64_t Refreshes::late_by(std::int64_t frame) const {
  if (errors_.work_ms <= 0) return 0;
  const twin::Random random(seed_, twin::Stream::frame_time);
  const auto k = static_cast<std::uint64_t>(frame);
  double work_ms = errors_.work_ms * std::exp(errors_.work_spread * random.normal(k, 0));
  if (random.uniform(k, 1) < errors_.stalls) work_ms += errors_.stall_ms;
  const double late = std::ceil((work_ms - software_ms_) * 1e-3 * rate_hz_);
  return std::clamp(static_cast<std::int64_t>(late), std::int64_t{0}, kLongestDelay);
}

std::int64_t Refreshes::shown_at(std::int64_t frame) const {
  std::int64_t shown = frame;
  while (shown > 0 && shown + late_by(shown) > frame) --shown;
  return shown;
}

}  // namespace handcast::simulate
