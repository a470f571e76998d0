// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// The owner word of a row for the calling process: its number and the time it started, since
/// numbers are used again. Nothing where the kernel does not tell (no descriptor left): with a
/// wrong time the process would be taken for dead.
std::optional<std::uint64_t> owner_word_of_this_process(std::uint64_t generation);

/// Whether a row with this owner word may be taken: free, or its process is dead, or its number
/// belongs to another by now.
bool owner_is_gone(std::uint64_t owner);

/// Frees the rows of readers that died with what they still leased; returns how many. Any process
/// may do it at any time, several at once, or die half way.
int sweep_dead_rows(const Segment& segment);

}  // namespace handcast::ipc
