// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>

/// Weak memory as a machine of views: release/acquire as in C++20, without promises.
///
///   history   A location keeps every value it was given, oldest first. A load may return any of
///   them that is not older than
///             what the thread knows: so a store is seen late, loads and stores overtake each
///             other, two threads disagree.
///   view      What a thread knows: per location, the newest place of the history it must not fall
///   behind. message   A value and the view that comes with it. An acquire load takes the view
///   over; a relaxed one only remembers it for
///             a later acquire fence. A release store sends the thread's own view; a relaxed one
///             what the last release fence saved.
///   release sequence   Only a read-modify-write hands the view of the message it replaces on; a
///   plain store on top does not. seq_cst fences     meet in one view that all of them join and
///   leave behind: hence their single order.
///
/// Outside it: load buffering (a load that sees a store which depends on nothing and comes later in
/// its own thread), and stores that enter a history elsewhere than at its end. The ring needs no
/// more: each of its words has one writer at a time, or changes by read-modify-write only.
namespace handcast::explorer {

inline constexpr int kMaxLocations = 32;
inline constexpr int kMaxMessages = 40;

struct alignas(16) View {
  std::uint8_t place[kMaxLocations];

  void join(const View& other) {
    for (int i = 0; i < kMaxLocations; ++i) place[i] = std::max(place[i], other.place[i]);
  }
  void raise(int location, int to) {
    place[location] = std::max(place[location], static_cast<std::uint8_t>(to));
  }
};

struct Message {
  View view;
  std::uint64_t value;
  std::uint64_t unused;
};

struct ThreadViews {
  View current;
  View acquirable;  ///< becomes current at an acquire fence
  View released;    ///< current as of the last release fence
};

struct Memory {
  std::uint8_t length[kMaxLocations];
  View fenced;  ///< what the seq_cst fences so far knew together
  Message history[kMaxLocations][kMaxMessages];

  int newest(int location) const { return length[location] - 1; }
  std::uint64_t newest_value(int location) const {
    return history[location][newest(location)].value;
  }
};

constexpr bool acquires(std::memory_order order) {
  return order == std::memory_order_acquire || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}
constexpr bool releases(std::memory_order order) {
  return order == std::memory_order_release || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}

inline std::uint64_t read(const Memory& memory, ThreadViews& self, int location, int place,
                          bool acquire) {
  const auto& message = memory.history[location][place];
  self.current.raise(location, place);
  self.acquirable.raise(location, place);
  self.acquirable.join(message.view);
  if (acquire) self.current.join(message.view);
  return message.value;
}

/// `replaced`: what a read-modify-write has read; null for a plain store.
inline void append(Memory& memory, ThreadViews& self, int location, std::uint64_t value,
                   bool release, const Message* replaced) {
  View view = release ? self.current : self.released;
  if (replaced) view.join(replaced->view);
  const int place = memory.length[location]++;
  view.place[location] = static_cast<std::uint8_t>(place);
  memory.history[location][place] = {view, value, 0};
  self.current.raise(location, place);
  self.acquirable.raise(location, place);
}

inline void local_fence(ThreadViews& self, std::memory_order order) {
  if (acquires(order)) self.current = self.acquirable;
  if (releases(order)) self.released = self.current;
}

inline void seq_cst_fence(Memory& memory, ThreadViews& self) {
  self.current = self.acquirable;
  self.current.join(memory.fenced);
  memory.fenced = self.acquirable = self.released = self.current;
}

}  // namespace handcast::explorer
