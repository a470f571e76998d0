// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "config/sections/projector.hpp"
#include "ipc/base/log.hpp"

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

}  // namespace handcast::projector
