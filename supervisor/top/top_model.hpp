// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "supervisor/top/top_look.hpp"

namespace handcast::supervisor {

inline constexpr std::int64_t kOldLease_ns = 100'000'000;  ///< a lease is meant to last one frame
inline constexpr double kLatePeriods =
    3;  ///< a ring whose newest message is older than so many periods is late

struct ServiceRow {
  std::string name, state, backend, last_exit;
  std::string trouble;  ///< of one that is not well: why, and its last log line
  pid_t pid = 0, spare_pid = 0;
  int restarts = 0;
  double uptime_s = 0;
  std::optional<ProcessUsage> usage;
  std::optional<double> cores;  ///< 1.0: one whole core

  bool well() const { return state == "ready" || state == "stopped"; }
};

struct ReaderRow {
  ipc::ReaderView now;
  std::string who;    ///< the service, or the program's name
  bool gone = false;  ///< its process is dead, its row not yet cleared
  std::optional<double> received_hz, skipped_hz;

  bool skips() const { return skipped_hz.value_or(0) > 0; }
  bool holds_an_old_lease() const;
};

struct RingRow {
  ipc::RingSnapshot now;
  std::optional<double> asked_hz;
  std::optional<double> rate_hz, dropped_hz;
  std::optional<std::int64_t> newest_age_ns;  ///< since it was published
  std::optional<std::int64_t> latency_ns;     ///< from its origin to its publication
  std::vector<ReaderRow> readers;

  bool late() const;
  bool drops() const { return dropped_hz.value_or(0) > 0; }
  /// A service's stage marks and heart-beats, not data.
  bool marks() const { return now.stream.starts_with("marks."); }
};

/// How many of the drawn hands were given a rung of the ladder.
struct RungShare {
  std::string rung;
  double share = 0;
};

/// What there is to show of a rig.
struct TopModel {
  std::string rig;
  std::string missing;  ///< why its supervisor does not answer; "" where it does
  double uptime_s = 0;
  std::vector<ServiceRow> services;
  std::vector<RingRow> rings;
  std::vector<RungShare>
      rungs;  ///< of the hands drawn since the look before, cheapest first; rungs that were taken
};

/// Rates are between the two looks; there are none for what has changed hands in between.
TopModel compare(const RigLook& before, const RigLook& now);

/// What `handcast top --json` prints.
nlohmann::json json_of(const TopModel& model);

}  // namespace handcast::supervisor
