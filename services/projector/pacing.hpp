// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "config/sections/projector.hpp"
#include "ipc/base/clock.hpp"

namespace handcast::projector {

/// Ticks at a steady rate, counted from the first: a late tick does not delay those after it,
/// missed ones are skipped.
class Pacer {
 public:
  explicit Pacer(double rate_hz)
      : period_ns_(std::max<std::int64_t>(seconds_to_ns(1 / rate_hz), 1)) {}

  /// The time of the first tick not before `time_ns` that was not given out yet.
  std::int64_t next_ns(std::int64_t time_ns) {
    if (start_ns_ == 0) start_ns_ = time_ns;
    const std::int64_t due = (time_ns - start_ns_ + period_ns_ - 1) / period_ns_;
    const std::int64_t tick = std::max(due, ticks_);
    skipped_ += tick - ticks_;
    ticks_ = tick + 1;
    return start_ns_ + tick * period_ns_;
  }
  std::int64_t skipped() const { return skipped_; }

 private:
  std::int64_t period_ns_;
  std::int64_t start_ns_ = 0, ticks_ = 0, skipped_ = 0;
};

/// Sleeps until then, and asks on the way whether to go on: a daemon must say that it lives more
/// often than a slow projector's frame comes. False: not to.
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

/// When the light of a frame begun now will be seen: after the software (the median of what the
/// last frames took, so that one slow frame does not move it), the projector's latency and half of
/// the time it is lit.
class Horizon {
 public:
  explicit Horizon(const config::Projector& settings)
      : light_ns_(ms_to_ns(settings.latency_ms) + seconds_to_ns(0.5 / settings.rate_hz)),
        software_ns_(ms_to_ns(settings.software_ms)) {
    recent_ns_.fill(software_ns_);
  }

  std::int64_t target_ns(std::int64_t begin_ns) const {
    return begin_ns + software_ns_ + light_ns_;
  }
  std::int64_t software_ns() const { return software_ns_; }

  /// The last frame was handed over so long after it was begun.
  void learn(std::int64_t software_ns) {
    recent_ns_[learnt_++ % recent_ns_.size()] = software_ns;
    auto sorted = recent_ns_;
    const auto middle = sorted.begin() + sorted.size() / 2;
    std::nth_element(sorted.begin(), middle, sorted.end());
    software_ns_ = *middle;
  }

 private:
  std::int64_t light_ns_;
  std::int64_t software_ns_;
  std::array<std::int64_t, 31> recent_ns_{};
  std::size_t learnt_ = 0;
};

}  // namespace handcast::projector
