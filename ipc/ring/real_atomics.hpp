// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <bit>
#include <cstdint>

#include "ipc/ring/words.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// The atomic operations of the protocol in production: lock-free words in shared memory, and a
/// futex on the low half of a word. Any thread, any process.
struct RealAtomics {
  /// One word in shared memory.
  struct Word {
    std::atomic<std::uint64_t> value;  ///< changed only through the functions below
  };
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free && sizeof(Word) == 8);
  static_assert(std::endian::native == std::endian::little,
                "the futex is the low half of the word at its own address");

  /// The operations of std::atomic with these names. compare_exchange() is the strong one, relaxed
  /// on failure; true if `word` was `expected`.
  /// @{
  static std::uint64_t load(const Word& word, std::memory_order order) {
    return word.value.load(order);
  }
  static void store(Word& word, std::uint64_t value, std::memory_order order) {
    word.value.store(value, order);
  }
  static bool compare_exchange(Word& word, std::uint64_t expected, std::uint64_t desired,
                               std::memory_order order) {
    return word.value.compare_exchange_strong(expected, desired, order, std::memory_order_relaxed);
  }
  static void fence(std::memory_order order) { std::atomic_thread_fence(order); }
  /// @}

  /// Sleeps while the low half of `word` equals that of `seen`, at most until `until_ns`
  /// (CLOCK_MONOTONIC). May return early, e.g. after a signal. Works between processes, unlike
  /// std::atomic::wait(), whose futex is private.
  static void wait(Word& word, std::uint64_t seen, std::int64_t until_ns);
  /// Wakes all threads of all processes that wait on `word`.
  static void wake(Word& word);
};

/// The control words of a mapped segment; valid as long as it is mapped.
inline ControlWords<RealAtomics> control_words_of(const Segment& segment) {
  auto* lines = reinterpret_cast<ControlWords<RealAtomics>::Line*>(segment.data() + kControlOffset);
  return {lines, segment.slots(), segment.keep_history()};
}

}  // namespace handcast::ipc
