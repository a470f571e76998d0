// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

#include "services/projector/projector.hpp"

namespace handcast::projector {

/// The times of a modelled projector: it takes one frame a period, on average, and lights each
/// `latency_ms` after it was handed over, for a period. A frame that came late may be followed by
/// one that comes early: lateness does not pile up.
class LightClock {
 public:
  explicit LightClock(const config::Projector& settings)
      : period_ns_(seconds_to_ns(1 / settings.rate_hz)),
        latency_ns_(ms_to_ns(settings.latency_ms)) {}

  Result<PresentTimes> take(Deadline deadline) {
    if (free_ns_ > now_ns()) {  // a sleep that is over before it begins would still cost the
                                // kernel's timer slack, 50 us
      sleep_until_ns(std::min(free_ns_, deadline.time_ns()));
      if (free_ns_ > deadline.time_ns())
        return fail(Errc::timeout, "projector: still busy with the last frame at the deadline");
    }
    const std::int64_t handed_ns = now_ns();
    free_ns_ = std::max(free_ns_ + period_ns_, handed_ns);
    return PresentTimes{handed_ns, handed_ns + latency_ns_ + period_ns_ / 2};
  }

 private:
  std::int64_t period_ns_, latency_ns_;
  std::int64_t free_ns_ = 0;  ///< when it takes the next frame
};

}  // namespace handcast::projector
