// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "tests/ipc/explorer/memory_model.hpp"

/// A state of the machine: plain bytes, which can be copied, hashed and compared.
namespace handcast::explorer {

/// Limits of the model: threads, actions of an operation, bytes of locals, sequences of a story.
/// @{
inline constexpr int kMaxThreads = 7;
inline constexpr int kMaxLog = 250;
inline constexpr int kLocalsBytes = 192;
inline constexpr int kMaxSequences = 16;
/// @}

/// The status of a thread.
enum class Status : std::uint8_t { absent, running, sleeping, finished, dead };

/// The state of a thread. A thread is a deterministic function of the values that its operations
/// returned, so its locals at the begin of the current operation and the values since then describe
/// it completely. No stack needs to be copied.
struct Thread {
  Status status;               ///< what it does
  std::uint8_t log_length;     ///< number of values in `log`
  std::uint8_t sleeps_on;      ///< location of the futex, if it sleeps
  bool urgent;                 ///< its next step may come first without loss: see Manner
  std::uint8_t unused[12];     ///< padding
  ThreadViews views;           ///< its knowledge of memory
  std::uint64_t log[kMaxLog];  ///< the values returned in the current operation
  alignas(16) std::byte locals[kLocalsBytes];  ///< the locals at its begin

  /// True if it runs or sleeps.
  bool lives() const { return status == Status::running || status == Status::sleeping; }
};

/// The state of all threads and of memory.
struct State {
  std::uint8_t published[kMaxSequences];  ///< the author of each sequence: see story.cpp
  Thread threads[kMaxThreads];            ///< the threads
  Memory memory;                          ///< the shared memory
};
static_assert(std::is_trivially_copyable_v<State>);

/// The parts of a state that are in use.
struct Extent {
  int threads = 0;    ///< number of threads
  int locations = 0;  ///< number of locations
};

/// Copies the parts of a state that are in use.
inline void copy_state(State& to, const State& from, const Extent& extent) {
  std::memcpy(to.published, from.published, sizeof to.published);
  for (int i = 0; i < extent.threads; ++i) {
    const auto& thread = from.threads[i];
    std::memcpy(&to.threads[i], &thread,
                offsetof(Thread, log) + sizeof(std::uint64_t) * thread.log_length);
    std::memcpy(to.threads[i].locals, thread.locals, kLocalsBytes);
  }
  std::memcpy(&to.memory, &from.memory, offsetof(Memory, history));
  for (int i = 0; i < extent.locations; ++i)
    std::memcpy(to.memory.history[i], from.memory.history[i],
                sizeof(Message) * from.memory.length[i]);
}

/// A hash of bytes: the sum of one product for each 16 bytes, each with its own key. The products
/// are independent, so they overlap in the processor.
class Hash {
 public:
  /// Adds bytes.
  void add(const void* bytes, std::size_t count) {
    const auto* at = static_cast<const std::byte*>(bytes);
    for (; count >= 16; at += 16, count -= 16) add_words(at, 16);
    if (count > 0) add_words(at, count);
  }
  /// The hash of all bytes so far.
  std::uint64_t value() const { return sum_ ^ sum_ >> 29; }

 private:
  void add_words(const std::byte* at, std::size_t count) {
    std::uint64_t words[2]{};
    std::memcpy(words, at, count);
    key_ += 0x9e3779b97f4a7c15;
    const auto product = static_cast<unsigned __int128>(words[0] ^ key_) *
                         (words[1] ^ (key_ << 32 | key_ >> 32) ^ 0xd1b54a32d192ed03);
    sum_ += static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
  }

  std::uint64_t sum_ = 0;
  std::uint64_t key_ = 0x2545f4914f6cdd1d;
};

/// The hash of a state. States with the same hash are considered equal: with 10 million states the
/// probability of an error is 1 in 300,000.
inline std::uint64_t hash_state(const State& state, const Extent& extent) {
  Hash hash;
  hash.add(state.published, sizeof state.published);
  for (int i = 0; i < extent.threads; ++i) {
    const auto& thread = state.threads[i];
    hash.add(&thread, offsetof(Thread, log) + sizeof(std::uint64_t) * thread.log_length);
    hash.add(thread.locals, kLocalsBytes);
  }
  hash.add(&state.memory, offsetof(Memory, history));
  for (int i = 0; i < extent.locations; ++i)
    hash.add(state.memory.history[i], sizeof(Message) * state.memory.length[i]);
  return hash.value();
}

}  // namespace handcast::explorer
