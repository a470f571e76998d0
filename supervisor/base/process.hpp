// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <optional>

namespace handcast::supervisor {

/// The start time of a process in clock ticks since boot (/proc/PID/stat, field 22): tells it from
/// another process that has the same number later. Empty if there is none, or only a zombie.
std::optional<std::uint64_t> start_ticks_of(pid_t pid);

/// A start time on the clock of now_ns(). Ticks count the time that the machine was asleep,
/// now_ns() does not.
std::int64_t start_ns_of(std::uint64_t ticks);

}  // namespace handcast::supervisor
