// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

/// Copies between a slot and private memory in words that are atomic on the side of the slot:
/// another process may access the same bytes at the same time, which is detected only afterwards.
/// Both sides are aligned to 8 bytes.
namespace handcast::ipc {

/// The unit of a copy.
using PayloadWord = std::uint64_t;

/// A relaxed atomic load or store of one word in a slot.
/// @{
inline PayloadWord load_relaxed(const PayloadWord& word) {
  return __atomic_load_n(&word, __ATOMIC_RELAXED);
}
inline void store_relaxed(PayloadWord& word, PayloadWord value) {
  __atomic_store_n(&word, value, __ATOMIC_RELAXED);
}
/// @}

/// Copies `bytes`, rounded up to whole words, from a slot to private memory.
inline void copy_from_slot(std::byte* to, const std::byte* slot, std::size_t bytes) {
  const auto* from = reinterpret_cast<const PayloadWord*>(slot);
  auto* out = reinterpret_cast<PayloadWord*>(to);
  const auto words = bytes / sizeof(PayloadWord) + (bytes % sizeof(PayloadWord) != 0);
  const auto* const end_of_fours = from + words / 4 * 4;
  for (; from != end_of_fours; from += 4, out += 4) {  // four loads in flight
    const auto a = load_relaxed(from[0]), b = load_relaxed(from[1]), c = load_relaxed(from[2]),
               d = load_relaxed(from[3]);
    out[0] = a, out[1] = b, out[2] = c, out[3] = d;
  }
  for (std::size_t i = 0; i < words % 4; ++i) out[i] = load_relaxed(from[i]);
}

/// Copies `bytes` from private memory to a slot. The last word is padded with zeros.
inline void copy_to_slot(std::byte* slot, const std::byte* message, std::size_t bytes) {
  auto* to = reinterpret_cast<PayloadWord*>(slot);
  for (std::size_t done = 0; done < bytes; done += sizeof(PayloadWord)) {
    PayloadWord word = 0;
    __builtin_memcpy(&word, message + done,
                     bytes - done < sizeof word ? bytes - done : sizeof word);
    store_relaxed(*to++, word);
  }
}

}  // namespace handcast::ipc
