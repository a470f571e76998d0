#pragma once
#include <cstdint>

namespace handcast::ipc {

/// The owner word of a row for the calling process: its number and the time it started, since numbers are used again.
std::uint64_t owner_word_of_this_process(std::uint64_t generation);

/// Whether a row with this owner word may be taken: free, or its process is dead, or its number belongs to another by now.
bool owner_is_gone(std::uint64_t owner);

}  // namespace handcast::ipc
