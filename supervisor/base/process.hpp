// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace handcast::supervisor {

/// The text of a file in /proc; "" if it cannot be read, for example because its process has ended
/// since it was opened. (The buffer of a std::ifstream throws in that case.)
std::string proc_text(const std::filesystem::path& file);

/// A field of the file `stat` of a process or thread (proc(5)), counted from 1, from the third on;
/// `folder`: /proc/PID or /proc/PID/task/TID. "" if there is no such process.
std::string stat_field(const std::filesystem::path& folder, int number);

/// A line of the file `status` of a process (proc(5)) without its name, e.g. "CapPrm"; "" if there
/// is none.
std::string status_line(const std::filesystem::path& folder, std::string_view name);

/// The start time of a process in clock ticks since boot (/proc/PID/stat, field 22). Together with
/// the pid it identifies the process, because pids are reused. Empty if there is no such process,
/// or only a zombie.
std::optional<std::uint64_t> start_ticks_of(pid_t pid);

/// The pid of the parent of a process. Empty if there is no such process, or only a zombie.
std::optional<pid_t> parent_of(pid_t pid);

/// The inode of an open file; 0 if it is not open.
std::uint64_t inode_of(int fd);

/// Converts a start time to CLOCK_MONOTONIC (ns). Ticks include the time during which the machine
/// was suspended, CLOCK_MONOTONIC does not.
std::int64_t start_ns_of(std::uint64_t ticks);

}  // namespace handcast::supervisor
