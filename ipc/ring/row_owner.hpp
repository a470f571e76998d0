// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// The owner word of the calling process: its pid and its start time, since pids are reused. Empty
/// if the start time cannot be read from /proc (no descriptor left): with a wrong time the process
/// would be mistaken for dead.
std::optional<std::uint64_t> owner_word_of_this_process(std::uint64_t generation);

/// True if a row with this owner word may be claimed: it is free, its process is dead, or its pid
/// now belongs to another process.
bool owner_is_gone(std::uint64_t owner);

/// Frees the rows of dead readers with their leases; returns how many. Any process may call it at
/// any time, several at once; a process that dies during the call does no harm.
int sweep_dead_rows(const Segment& segment);

}  // namespace handcast::ipc
