// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// A moment on the clocks that a trace viewer may ask about.
struct ClockReadings {
  std::int64_t monotonic_ns = 0, boottime_ns = 0, realtime_ns = 0;
  static ClockReadings now();
};

/// The history as a trace for ui.perfetto.dev: the bytes of a perfetto.protos.Trace of TrackEvents.
/// A track per service, slices for its stages (`correct` with the rung each hand was given), flows
/// from the sensors to the light (trace_flows.hpp), a counter for the age of the image in the
/// light. Times are CLOCK_MONOTONIC's, as in every log and message of the house.
std::string perfetto_trace(const HistorySnapshot& history, std::string_view rig,
                           const ClockReadings& clocks);

}  // namespace handcast::supervisor
