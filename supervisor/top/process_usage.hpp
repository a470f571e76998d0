// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace handcast::supervisor {

/// What a process uses, at one moment.
struct ProcessUsage {
  std::string
      program;  ///< its name as the kernel has it: at most 15 characters, and whatever it likes
  std::int64_t taken_ns = 0;  ///< when this was looked up
  std::int64_t cpu_ns = 0;    ///< processor time since its start, of all its threads
  std::uint64_t started_ticks =
      0;  ///< since boot: with the number it tells a process from a later one
  std::int64_t resident_bytes = 0;  ///< in memory now
  std::int64_t shared_bytes =
      0;  ///< of these, shared with others: the rings, its program, libraries
  int threads = 0;
  int descriptors = 0;  ///< open ones; -1: not to be known
  int last_core = 0;    ///< of its first thread, as is what follows
  int policy = 0;       ///< SCHED_OTHER, SCHED_FIFO, …
  int priority = 0;     ///< real-time priority; 0: none
  int nice = 0;

  std::int64_t own_bytes() const { return resident_bytes - shared_bytes; }
};

/// Takes in the text of /proc/PID/stat; false where it makes no sense.
bool read_stat(std::string_view text, std::int64_t ticks_per_second, ProcessUsage& usage);
/// The same with /proc/PID/statm.
bool read_statm(std::string_view text, std::int64_t page_bytes, ProcessUsage& usage);

/// Empty where there is no such process, or only what its parent has not taken yet. Costs some 30
/// us, and the process nothing: what would hold its memory map (smaps) is left alone, so there is
/// no proportional share of the rings.
std::optional<ProcessUsage> usage_of(pid_t pid);

/// In cores (1.0: one whole core) between two looks; empty where they are not of the same process.
std::optional<double> cores_used(const ProcessUsage& before, const ProcessUsage& now);

/// "FIFO 50", "nice 10", "idle", …; "" for what every program has.
std::string scheduling_of(const ProcessUsage& usage);

}  // namespace handcast::supervisor
