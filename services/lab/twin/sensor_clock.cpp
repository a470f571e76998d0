// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/sensor_clock.hpp"

#include "ipc/base/clock.hpp"

namespace handcast::twin {
namespace {

constexpr std::int64_t kMapUpdate_ns = 1'000'000'000;
constexpr double kScatterLimit = 0.45;  ///< share of the period: below a half, so stamps ascend

/// Time since the last update of the map. `time_ns` may be negative.
std::int64_t since_update_ns(std::int64_t time_ns) {
  const std::int64_t rest_ns = time_ns % kMapUpdate_ns;
  return rest_ns < 0 ? rest_ns + kMapUpdate_ns : rest_ns;
}

}  // namespace

SensorClock::SensorClock(const config::TwinClock& clock, double skew_ms, std::int64_t period_ns,
                         Random scatter)
    : clock_(clock),
      skew_ns_(ms_to_ns(skew_ms)),
      limit_ns_(static_cast<std::int64_t>(kScatterLimit * static_cast<double>(period_ns))),
      scatter_(scatter) {}

std::int64_t SensorClock::stamp_ns(std::uint64_t k, std::int64_t true_ns) const {
  const auto drift_ns = static_cast<std::int64_t>(clock_.drift_ppm * 1e-6 *
                                                  static_cast<double>(since_update_ns(true_ns)));
  const std::int64_t scatter_ns =
      clock_.jitter_ms > 0 ? ms_to_ns(clock_.jitter_ms * scatter_.normal(k)) : 0;
  return true_ns + skew_ns_ + drift_ns + std::clamp(scatter_ns, -limit_ns_, limit_ns_);
}

}  // namespace handcast::twin
