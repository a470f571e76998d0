// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "config/sections/twin/clock.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {

/// The stamps of a sensor whose clock is not the rig's. The driver maps the sensor's clock to the
/// rig's by a lower envelope (calib/clock_map.hpp). The model updates the map once a second, so
/// that an item taken s seconds after the update has an error of s times the rate error; the
/// scatter of the stamps adds to it. Pure functions.
class SensorClock {
 public:
  /// Copies its arguments. `period_ns`: time between two items.
  SensorClock(const config::TwinClock& clock, double skew_ms, std::int64_t period_ns,
              Random scatter);

  /// The stamp of item `k`, taken at `true_ns`. Stamps ascend: their scatter is limited to 0.45 of
  /// the period.
  std::int64_t stamp_ns(std::uint64_t k, std::int64_t true_ns) const;

 private:
  config::TwinClock clock_;
  std::int64_t skew_ns_, limit_ns_;
  Random scatter_;
};

/// The most items that arrive together in a burst.
inline constexpr std::uint64_t kLongestBurst = 64;

/// The arrival of item `k`. `share` of the items arrive late, together with the next one; several
/// in a row arrive with the first item that is not late. `alone_ns(k)`: the arrival without bursts.
template <class Alone>
std::int64_t burst_arrival_ns(std::uint64_t k, double share, const Random& random,
                              const Alone& alone_ns) {
  std::int64_t arrival_ns = alone_ns(k);
  for (auto i = k; i < k + kLongestBurst && random.uniform(i) < share; ++i)
    arrival_ns = std::max<std::int64_t>(arrival_ns, alone_ns(i + 1));
  return arrival_ns;
}

}  // namespace handcast::twin
