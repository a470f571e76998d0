// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "tests/ipc/explorer/memory_model.hpp"

/// A state of the machine: plain bytes, so that it can be copied, hashed and compared.
namespace handcast::explorer {

inline constexpr int kMaxThreads = 7;
inline constexpr int kMaxLog = 250;
inline constexpr int kLocalsBytes = 192;
inline constexpr int kMaxSequences = 16;

enum class Status : std::uint8_t { absent, running, sleeping, finished, dead };

/// A thread is a deterministic function of what its operations gave back. So it is wholly described
/// by its locals when its current operation began and by the values since: no stack has to be
/// copied.
struct Thread {
  Status status;
  std::uint8_t log_length;
  std::uint8_t sleeps_on;
  bool urgent;  ///< its next step may as well come before anybody else's: see Manner
  std::uint8_t unused[12];
  ThreadViews views;
  std::uint64_t log[kMaxLog];
  alignas(16) std::byte locals[kLocalsBytes];

  bool lives() const { return status == Status::running || status == Status::sleeping; }
};

struct State {
  std::uint8_t published[kMaxSequences];  ///< who gave which sequence to the world: bookkeeping of
                                          ///< the ring's properties
  Thread threads[kMaxThreads];
  Memory memory;
};
static_assert(std::is_trivially_copyable_v<State>);

/// How much of a state is in use: threads, and locations that have a history.
struct Extent {
  int threads = 0;
  int locations = 0;
};

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

/// Sums a product for every 16 bytes, each with a key of its own: the products do not wait for each
/// other.
class Hash {
 public:
  void add(const void* bytes, std::size_t count) {
    const auto* at = static_cast<const std::byte*>(bytes);
    for (; count >= 16; at += 16, count -= 16) add_words(at, 16);
    if (count > 0) add_words(at, count);
  }
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

/// Two states of the same hash are taken for one: with 10 million states the odds of an error are 1
/// in 300,000.
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
