// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// Durations of one kind, all of them: percentiles are those of the sorted truth.
class Spans {
 public:
  explicit Spans(std::vector<std::int64_t> spans_ns);
  std::size_t count() const { return sorted_ns_.size(); }
  const std::vector<std::int64_t>& sorted_ns() const { return sorted_ns_; }
  /// The time that `share` (0..1) of the spans did not exceed (nearest rank); 0 if there are none.
  std::int64_t percentile_ns(double share) const;

 private:
  std::vector<std::int64_t> sorted_ns_;
};

struct StageLatency {
  std::string service, stage;
  Spans spans;
};

/// From one event of a frame's way to another.
struct WayLatency {
  std::string from, to;
  Spans spans;
};

/// What a service did not do in its time.
struct Misses {
  std::string service;
  std::uint64_t frames = 0;
  double asked_hz = 0;       ///< 0: as fast as it can
  double held_hz = 0;        ///< over the time from its first to its last frame
  std::uint64_t missed = 0;  ///< periods of the asked rate that passed without a frame, and were
                             ///< not made good by the next one
  std::uint64_t late = 0;    ///< frames that came more than 1.5 periods after the one before
  std::uint64_t skipped_ids = 0;  ///< of a sensor: numbers that never came
  std::int64_t longest_gap_ns = 0;
  std::uint64_t lost_marks =
      0;  ///< frames whose marks the recorder came too late for; in none of the figures above
};

struct LatencyTable {
  double seconds = 0;  ///< from the first mark to the last
  std::vector<StageLatency> stages;
  std::vector<WayLatency> ways;
  std::vector<Misses> misses;
};

/// `asked_hz` by service; those not in it run as fast as they can.
LatencyTable measure_latency(const HistorySnapshot& history,
                             const std::map<std::string, double>& asked_hz);

nlohmann::json to_json(const LatencyTable& table);
std::string print_latency(const LatencyTable& table);

}  // namespace handcast::supervisor
