// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "config/sections/projector.hpp"
#include "ipc/base/clock.hpp"
#include "services/projector/projector.hpp"
#include "services/projector/recent_times.hpp"

namespace handcast::projector {

/// Ticks at a constant rate, counted from the first one: a late tick does not delay later ones, and
/// missed ticks are skipped.
class Pacer {
 public:
  /// A pacer without ticks yet; the first next_ns() sets the phase.
  explicit Pacer(double rate_hz)
      : period_ns_(std::max<std::int64_t>(seconds_to_ns(1 / rate_hz), 1)) {}

  /// The time of the next tick: the first one at `time_ns` or later that was not returned before.
  std::int64_t next_ns(std::int64_t time_ns) {
    if (start_ns_ == 0) start_ns_ = time_ns;
    const std::int64_t due = (time_ns - start_ns_ + period_ns_ - 1) / period_ns_;
    const std::int64_t tick = std::max(due, ticks_);
    skipped_ += tick - ticks_;
    ticks_ = tick + 1;
    return start_ns_ + tick * period_ns_;
  }
  /// Number of ticks that were missed.
  std::int64_t skipped() const { return skipped_; }

 private:
  std::int64_t period_ns_;
  std::int64_t start_ns_ = 0, ticks_ = 0, skipped_ = 0;
};

/// Sleeps until `time_ns` (CLOCK_MONOTONIC) and calls `running` at least every 50 ms, because the
/// heartbeat of a daemon must not depend on the rate of the projector. Returns false as soon as
/// `running` does.
template <class Running>
bool sleep_while(const Running& running, std::int64_t time_ns) {
  constexpr std::int64_t kStep_ns = 50'000'000;
  while (running()) {
    const std::int64_t step_ns = std::min(time_ns, now_ns() + kStep_ns);
    sleep_until_ns(step_ns);
    if (step_ns == time_ns) return true;
  }
  return false;
}

/// Predicts when the light of a frame will be seen, by the medians of the time of the software and
/// of the time from there to the light.
class Horizon {
 public:
  /// Starts with the times of the settings.
  explicit Horizon(const config::Projector& settings)
      : software_(ms_to_ns(settings.software_ms)),
        light_(ms_to_ns(settings.latency_ms) + seconds_to_ns(0.5 / settings.rate_hz)) {}

  /// The middle of the time at which a frame that is begun at `begin_ns` will be lit.
  std::int64_t target_ns(std::int64_t begin_ns) const {
    return begin_ns + software_.median_ns() + light_.median_ns();
  }
  /// When to begin a frame that the projector can take at `handed_ns`: a little sooner than needed,
  /// because a frame that misses its refresh waits for a whole one.
  std::int64_t begin_ns(std::int64_t handed_ns) const {
    return handed_ns - software_.median_ns() - software_.median_ns() / 4 - kMargin_ns;
  }

  /// Adds the times of a frame that was begun at `begin_ns`.
  void learn(std::int64_t begin_ns, const PresentTimes& times) {
    software_.add(times.handed_ns - begin_ns);
    light_.add(times.display_ns - times.handed_ns);
  }

 private:
  static constexpr std::int64_t kMargin_ns = 300'000;

  RecentTimes software_, light_;
};

}  // namespace handcast::projector
