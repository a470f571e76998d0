// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// One moment on three clocks, with which a trace viewer can convert times.
struct ClockReadings {
  /// CLOCK_MONOTONIC, CLOCK_BOOTTIME and CLOCK_REALTIME.
  /// @{
  std::int64_t monotonic_ns = 0, boottime_ns = 0, realtime_ns = 0;
  /// @}
  /// The present time.
  static ClockReadings now();
};

/// The history as a trace for ui.perfetto.dev: the bytes of a perfetto.protos.Trace of TrackEvents.
/// It has a track for each service with a slice for each stage (`correct` is annotated with the
/// rung of each hand), flows from the sensors to the light (trace_flows.hpp), and a counter for the
/// age of the image in the light. Times are CLOCK_MONOTONIC.
std::string perfetto_trace(const HistorySnapshot& history, std::string_view rig,
                           const ClockReadings& clocks);

}  // namespace handcast::supervisor
