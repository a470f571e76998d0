// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/settings/field.hpp"

namespace handcast::config {

/// The clock of a sensor of the twin beside the rig's.
struct TwinClock {
  double drift_ppm = 0;  ///< rate error
  double jitter_ms = 0;  ///< standard deviation of a stamp's error

  bool operator==(const TwinClock&) const = default;
};

/// Declares the settings of a clock.
template <class Visitor>
void describe_clock(Visitor& visitor, TwinClock& clock) {
  visitor.field("clock_drift_ppm", clock.drift_ppm, between(-1000, 1000, "ppm"),
                "Rate error of the sensor's clock. A stamp is mapped to the rig's clock by a lower "
                "envelope, as the drivers do, which leaves the drift since the map's last update, "
                "one second at most.");
  visitor.field("clock_jitter_ms", clock.jitter_ms, between(0, 20, "ms"),
                "Standard deviation of the error of a time stamp.");
}

}  // namespace handcast::config
