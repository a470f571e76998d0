// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <bit>
#include <cstdint>

namespace handcast::ipc {

/// The protocol's atomics in production: lock-free words in shared memory, and a futex on the low
/// half of a word.
struct RealAtomics {
  struct Word {
    std::atomic<std::uint64_t> value;
  };
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free && sizeof(Word) == 8);
  static_assert(std::endian::native == std::endian::little,
                "the futex is the low half of the word at its own address");

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

  /// Sleeps while the low half of `word` is that of `seen`, at most until `until_ns`
  /// (CLOCK_MONOTONIC), and returns early after a signal. Works between processes:
  /// std::atomic::wait does not, its futex is private.
  static void wait(Word& word, std::uint64_t seen, std::int64_t until_ns);
  static void wake(Word& word);  ///< everyone who waits on it
};

}  // namespace handcast::ipc
