// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/frame_times.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ipc/base/log.hpp"

namespace handcast::camera::leap {
namespace {

/// No image arrives before it was taken; two clocks, and a period that is not yet known well, may
/// make it look so, but never by as much.
constexpr double kLargestAdvance_ns = 5e8;
/// Stamps are ignored after this many images whose stamps contradict their arrivals.
constexpr int kMostBad = 20;
/// Within a gap of fewer periods, arrivals without stamps tell nothing: they may come late.
constexpr double kLateAtMost = 10;

}  // namespace

FrameTimes::FrameTimes(std::uint32_t clock_hz, std::int64_t period_ns)
    : ticks_per_s_(clock_hz),
      period_ns_(static_cast<double>(period_ns)),
      are_stamps_good_(clock_hz > 0) {}

FrameTimes::Place FrameTimes::add(const EndedFrame& frame) {
  Place place{.arrival_ns = frame.first_ns, .error_ns = static_cast<std::int64_t>(period_ns_)};
  if (has_begun_) {
    place.steps = steps_to(frame);
    number_ += static_cast<double>(place.steps);
  }
  if (!std::exchange(has_begun_, true)) begun_ns_ = frame.first_ns;
  device_ns_ += static_cast<double>(place.steps) * period_ns_;
  last_ = frame;
  if (!are_stamps_good_ || !frame.stamp) return place;
  refine_period();
  const auto device_ns = static_cast<std::int64_t>(device_ns_);
  // The first payload of a torn image may be lost.
  if (frame.is_whole) clock_.add(device_ns, frame.first_ns);
  const auto earliest = clock_.earliest_arrival(device_ns);
  place.arrival_ns = std::min(earliest.ns, frame.first_ns);
  place.error_ns = earliest.error_ns;
  return place;
}

std::uint64_t FrameTimes::steps_to(const EndedFrame& frame) {
  const auto arrival_ns = static_cast<double>(frame.first_ns - last_.first_ns);
  if (are_stamps_good_ && frame.stamp && last_.stamp) {
    const auto steps = steps_by_stamps(frame);
    const double delay_ns = static_cast<double>(frame.first_ns - begun_ns_) - device_ns_ -
                            static_cast<double>(steps) * period_ns_;
    if (steps > 0 && delay_ns > least_delay_ns_ - kLargestAdvance_ns) {
      bad_in_a_row_ = 0;
      least_delay_ns_ = std::min(least_delay_ns_, delay_ns);
      ticks_ += *frame.stamp - *last_.stamp;
      return steps;
    }
    if (++bad_in_a_row_ == kMostBad) {
      are_stamps_good_ = false;
      log::warning("the stamps of the images are no times; their arrivals count");
    }
    ticks_ += std::max(arrival_ns, period_ns_) * 1e-9 * ticks_per_s_;
  }
  const std::uint64_t steps = frame.frame_id == last_.frame_id ? 2 : 1;
  const double by_arrival = std::round(arrival_ns / period_ns_);
  return by_arrival < kLateAtMost ? steps : std::max(steps, static_cast<std::uint64_t>(by_arrival));
}

/// 0: the clock stood still or went back.
std::uint64_t FrameTimes::steps_by_stamps(const EndedFrame& frame) const {
  const std::uint32_t ticks = *frame.stamp - *last_.stamp;
  if (ticks > UINT32_MAX / 2) return 0;
  return static_cast<std::uint64_t>(std::round(ticks / ticks_per_s_ * 1e9 / period_ns_));
}

/// A stamp is off by a tick at most, so the period is known the better the more images have come.
void FrameTimes::refine_period() {
  if (number_ < refine_at_) return;
  const double measured_ns = ticks_ / ticks_per_s_ * 1e9 / number_;
  if (std::abs(measured_ns / period_ns_ - 1) < 0.05) period_ns_ = measured_ns;
  refine_at_ *= 4;
}

}  // namespace handcast::camera::leap
