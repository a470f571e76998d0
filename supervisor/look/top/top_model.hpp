// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "supervisor/look/top/top_look.hpp"

namespace handcast::supervisor {

/// A lease that is older than this is reported: it should last one frame.
inline constexpr std::int64_t kOldLease_ns = 100'000'000;
/// A ring is late if its newest message is older than this number of periods.
inline constexpr double kLatePeriods = 3;

/// One service of a rig.
struct ServiceRow : ServiceFigures {
  std::string name;
  std::string trouble;                ///< the reason if it is not well, and its last line
  std::optional<ProcessUsage> usage;  ///< empty if the process is dead
  std::optional<double> cores;        ///< processor use since the last look; 1.0: one whole core
};

/// One reader of a ring.
struct ReaderRow {
  ipc::ReaderView now;  ///< its state
  std::string who;      ///< name of the service or program
  bool gone = false;    ///< the process is dead, and its row not yet freed
  /// Messages read and skipped per second; empty if unknown.
  /// @{
  std::optional<double> received_hz, skipped_hz;
  /// @}

  /// True if the reader has skipped messages since the last look.
  bool skips() const { return skipped_hz.value_or(0) > 0; }
  /// True if a lease is older than kOldLease_ns.
  bool holds_an_old_lease() const;
};

/// One ring with its readers.
struct RingRow {
  ipc::RingSnapshot now;            ///< its state
  std::optional<double> wanted_hz;  ///< the configured rate; empty if there is none
  /// Messages published and dropped per second; empty if unknown.
  /// @{
  std::optional<double> rate_hz, dropped_hz;
  /// @}
  std::optional<std::int64_t> newest_age_ns;  ///< time since the newest message was published
  std::optional<std::int64_t> latency_ns;     ///< time from its origin to its publication
  std::vector<ReaderRow> readers;             ///< the readers

  /// True if the newest message is older than kLatePeriods periods, or than 1 s if the ring has no
  /// regular rate.
  bool late() const;
  /// True if the writer has dropped messages since the last look.
  bool drops() const { return dropped_hz.value_or(0) > 0; }
  /// True for a ring of stage marks and heartbeats.
  bool marks() const { return now.stream.starts_with("marks."); }
};

/// How many images were lost for one reason.
struct ReasonCount {
  std::string reason;
  double count = 0;
};

/// The share of the drawn hands that got a rung of the ladder.
struct RungShare {
  std::string rung;  ///< name of the rung
  double share = 0;  ///< 0..1
};

/// The contents of `handcast top`.
struct TopModel {
  std::string rig;                   ///< name of the rig
  std::string missing;               ///< why the supervisor does not answer; empty if it does
  double uptime_s = 0;               ///< time since the supervisor was started
  std::vector<ServiceRow> services;  ///< the services
  std::vector<RingRow> rings;        ///< the rings
  /// The rungs of the hands that were drawn since the last look, cheapest first. Unused ones are
  /// left out.
  std::vector<RungShare> rungs;
  /// The images that the camera lost since the last look, by reason. Reasons without a loss are
  /// left out.
  std::vector<ReasonCount> lost_images;
};

/// Compares two looks at a rig. Rates are those between the looks; they are empty for a service,
/// ring or reader whose process has changed.
TopModel compare(const RigLook& before, const RigLook& now);

/// The output of `handcast top --json`.
nlohmann::json json_of(const TopModel& model);

}  // namespace handcast::supervisor
