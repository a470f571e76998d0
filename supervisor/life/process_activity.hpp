// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace handcast::supervisor {

/// What a process did between two looks at it.
enum class Activity {
  unknown,  ///< it was not looked at twice, or the system does not tell
  stopped,  ///< all its threads are stopped, by a signal or a debugger
  asleep,   ///< all its threads slept: none used a processor or waited for one
  busy      ///< a thread worked, waited for a processor, or waited for the kernel (disk, memory)
};

/// The threads of a process at one moment, from /proc/PID/task.
struct ProcessLook {
  std::size_t threads = 0;   ///< number of threads
  bool all_stopped = false;  ///< each is stopped
  bool all_asleep = false;   ///< each sleeps, and may be interrupted by a signal
  /// Sum over all threads of the time on a processor (ns), the time of waiting for one (ns), and
  /// the number of times it got one. 0 if the system does not count them.
  std::uint64_t progress = 0;
  std::int64_t worked_ns = 0;  ///< of `progress`, the time on a processor
  std::int64_t waited_ns = 0;  ///< of `progress`, the time of waiting for one
  bool on_disk = false;        ///< a thread waits for the kernel: for a disk, or for memory
};

/// Looks at a process; empty if there is none. Takes about 20 us per thread.
std::optional<ProcessLook> look_at_process(pid_t pid);

/// What the process did between two looks.
Activity activity_between(const std::optional<ProcessLook>& before,
                          const std::optional<ProcessLook>& now);

/// For how much of the time between two looks a process could not work: its threads waited for a
/// processor, or one for the disk. 0 if nothing is known.
std::int64_t held_up_ns(const std::optional<ProcessLook>& before,
                        const std::optional<ProcessLook>& now, std::int64_t between_ns);

}  // namespace handcast::supervisor
