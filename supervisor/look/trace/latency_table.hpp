// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "supervisor/record/counts.hpp"
#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// A set of durations with exact percentiles.
class Spans {
 public:
  /// Takes the durations in any order.
  explicit Spans(std::vector<std::int64_t> spans_ns);
  /// Number of durations.
  std::size_t count() const { return sorted_ns_.size(); }
  /// All durations, shortest first.
  const std::vector<std::int64_t>& sorted_ns() const { return sorted_ns_; }
  /// The duration that the fraction `share` (0..1) of all durations did not exceed (nearest rank);
  /// 0 if there are none.
  std::int64_t percentile_ns(double share) const;

 private:
  std::vector<std::int64_t> sorted_ns_;
};

/// The times of one stage of one service.
struct StageLatency {
  /// Names of the service and the stage.
  /// @{
  std::string service, stage;
  /// @}
  Spans spans;  ///< one duration for each frame
};

/// The times between two events on the way of a frame.
struct WayLatency {
  /// Names of the events.
  /// @{
  std::string from, to;
  /// @}
  Spans spans;  ///< one duration for each frame
};

/// The rate that a service held, and its missed and late frames.
struct Misses {
  std::string service;       ///< name of the service
  std::uint64_t frames = 0;  ///< number of recorded frames
  double wanted_hz = 0;      ///< the configured rate; 0: the service has no fixed rate
  double held_hz = 0;        ///< frames per second from the first to the last frame
  /// Periods of wanted_hz without a frame, unless the next frames caught up.
  std::uint64_t missed = 0;
  std::uint64_t late = 0;           ///< frames more than 1.5 periods after the one before
  std::uint64_t skipped_ids = 0;    ///< for a sensor: frame numbers that were left out
  std::int64_t longest_gap_ns = 0;  ///< longest time between two frames
  /// Frames whose marks were overwritten before the recorder read them. They count for held_hz, but
  /// not as missed, late or skipped, nor for the longest gap.
  std::uint64_t lost_marks = 0;
};

/// The contents of `handcast latency`.
struct LatencyTable {
  double seconds = 0;                        ///< time from the first mark to the last
  std::vector<StageLatency> stages;          ///< the stages of all services
  std::vector<WayLatency> ways;              ///< the ways from sensors to light
  std::vector<Misses> misses;                ///< the rates of all services with frames
  std::map<std::string, LightCount> lights;  ///< by projector
};

/// Computes the table. `wanted_hz`: the configured rates by service; services without a fixed rate
/// are left out.
LatencyTable measure_latency(const HistorySnapshot& history,
                             const std::map<std::string, double>& wanted_hz);

/// The output of `handcast latency --json`.
nlohmann::json to_json(const LatencyTable& table);
/// The output of `handcast latency`.
std::string print_latency(const LatencyTable& table);

}  // namespace handcast::supervisor
