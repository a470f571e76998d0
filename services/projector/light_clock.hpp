// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "config/sections/projector.hpp"
#include "ipc/base/log.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {

/// Counts the refreshes between frames by their times.
class Refreshes {
 public:
  /// Number of refreshes from the last frame to this one (msg::LightNote::refreshes); 0 for the
  /// first one.
  std::uint32_t since_last(std::int64_t time_ns, std::int64_t refresh_ns) {
    const std::int64_t span_ns = time_ns - std::exchange(last_ns_, time_ns);
    if (span_ns == time_ns) return 0;
    return static_cast<std::uint32_t>(
        std::max<std::int64_t>((span_ns + refresh_ns / 2) / refresh_ns, 1));
  }

 private:
  std::int64_t last_ns_ = 0;
};

/// Warns if the refresh of an output is not the rate in the settings, by which frames count as
/// missed.
inline void warn_if_rates_differ(std::int64_t refresh_ns, const config::Projector& settings) {
  const double hz = 1e9 / static_cast<double>(refresh_ns);
  if (std::abs(settings.rate_hz / hz - 1) > 0.02)
    log::warning("the display runs at {:.4g} Hz and projector.rate_hz is {:.4g}", hz,
                 settings.rate_hz);
}

/// The times of a simulated projector. It takes one frame per period on average, and lights it for
/// one period, `latency_ms` after it was handed over. After a late frame the next one may follow
/// sooner, so delays do not add up. One thread.
class LightClock {
 public:
  /// Uses rate_hz and latency_ms.
  explicit LightClock(const config::Projector& settings)
      : period_ns_(seconds_to_ns(1 / settings.rate_hz)),
        latency_ns_(ms_to_ns(settings.latency_ms)) {}

  /// Waits until the projector is free and takes a frame. Errors: timeout (it was still busy at the
  /// deadline).
  Result<PresentTimes> take(Deadline deadline) {
    if (free_ns_ > now_ns()) {
      sleep_until_ns(std::min(free_ns_, deadline.time_ns()));
      if (free_ns_ > deadline.time_ns())
        return fail(Errc::timeout,
                    "projector: it was still busy with the last frame at the deadline");
    }
    const std::int64_t handed_ns = now_ns();
    free_ns_ = std::max(free_ns_ + period_ns_, handed_ns);
    return PresentTimes{
        .handed_ns = handed_ns,
        .display_ns = handed_ns + latency_ns_ + period_ns_ / 2,
        .note = {msg::LightSource::settings, refreshes_.since_last(handed_ns, period_ns_)}};
  }

 private:
  std::int64_t period_ns_, latency_ns_;
  Refreshes refreshes_;
  std::int64_t free_ns_ = 0;  ///< when the projector can take the next frame
};

}  // namespace handcast::projector
