// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/settings/field.hpp"

namespace handcast::config {

/// [twin.projector]
struct TwinProjector {
  double work_ms = 0;
  double work_spread = 0.17;
  double stalls = 0;
  double stall_ms = 4;
  double rate_ppm = 0;
};

template <class Visitor>
void describe(Visitor& visitor, TwinProjector& projector) {
  visitor.field(
      "work_ms", projector.work_ms, between(0, 1000, "ms"),
      "Simulator: median time of a frame. One that takes longer than projector.software_ms "
      "misses its refresh: the light of the frame before stays on. Refreshes that begin while a "
      "frame is drawn get no frame of their own. 0: every frame is in time.");
  visitor.field("work_spread", projector.work_spread, between(0, 2),
                "Simulator: standard deviation of the logarithm of that time.");
  visitor.field("stalls", projector.stalls, between(0, 1),
                "Simulator: share of frames that take stall_ms longer.");
  visitor.field("stall_ms", projector.stall_ms, between(0, 1000, "ms"), "See stalls.");
  visitor.field("rate_ppm", projector.rate_ppm, between(-100000, 100000, "ppm"),
                "Simulator: rate error of the projector's refresh clock.");
}

}  // namespace handcast::config
