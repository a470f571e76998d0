// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace handcast::supervisor {

/// The resources that a process uses at one moment.
struct ProcessUsage {
  /// The name of the process in the kernel: at most 15 characters, which may be any.
  std::string program;
  std::int64_t taken_ns = 0;  ///< when this was read, CLOCK_MONOTONIC
  std::int64_t cpu_ns = 0;    ///< processor time of all threads since the start
  /// Start time in clock ticks since boot. Together with the pid it identifies the process.
  std::uint64_t started_ticks = 0;
  std::int64_t resident_bytes = 0;  ///< memory in RAM
  /// The part of resident_bytes that is shared with others: rings, program, libraries.
  std::int64_t shared_bytes = 0;
  int threads = 0;      ///< number of threads
  int descriptors = 0;  ///< number of open descriptors; -1: not permitted to read
  /// Of the first thread: the core it ran on last, its policy (SCHED_OTHER, SCHED_FIFO, …),
  /// real-time priority (0: none) and nice value.
  /// @{
  int last_core = 0;
  int policy = 0;
  int priority = 0;
  int nice = 0;
  /// @}

  /// Memory that is not shared.
  std::int64_t own_bytes() const { return resident_bytes - shared_bytes; }
};

/// Parses /proc/PID/stat or /proc/PID/statm into `usage`. Returns false if the text is invalid, or
/// (read_stat()) if the process is dead.
/// @{
bool read_stat(std::string_view text, std::int64_t ticks_per_second, ProcessUsage& usage);
bool read_statm(std::string_view text, std::int64_t page_bytes, ProcessUsage& usage);
/// @}

/// The usage of a process; empty if there is no such process, or a zombie. Takes about 30 us and
/// does not disturb the process: smaps, which locks its memory map, is not read, so the
/// proportional share of the rings is unknown.
std::optional<ProcessUsage> usage_of(pid_t pid);

/// The number of cores used between two readings (1.0: one whole core); empty if they are not of
/// the same process.
std::optional<double> cores_used(const ProcessUsage& before, const ProcessUsage& now);

/// The scheduling class: "FIFO 50", "nice 10", "idle", …; empty for the default.
std::string scheduling_of(const ProcessUsage& usage);

}  // namespace handcast::supervisor
