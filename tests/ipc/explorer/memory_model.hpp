// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>

/// A model of weak memory with views: release/acquire as in C++20, without promises.
///
/// - History: a location keeps all values that were stored, oldest first. A load may return any
///   value that is not older than what its thread knows. So stores may be seen late, loads and
///   stores may overtake each other, and threads may disagree.
/// - View: the knowledge of a thread. For each location, the place in its history before which the
///   thread must not read.
/// - Message: a value with a view. An acquire load joins the view into that of its thread; a
///   relaxed load only keeps it for a later acquire fence. A release store attaches the view of its
///   thread; a relaxed store attaches the view of the last release fence.
/// - Release sequence: only a read-modify-write passes on the view of the message that it replaces;
///   a plain store does not.
/// - Fences of order seq_cst join one common view and update it, which gives them a single order.
///
/// Not modelled: load buffering (a load that sees a store which is independent of it and comes
/// later in the same thread), and stores that enter a history before its end. The ring needs
/// neither: each of its words has one writer at a time, or is changed only by read-modify-write.
namespace handcast::explorer {

/// Limits of the model: the number of locations, and of messages in a history.
/// @{
inline constexpr int kMaxLocations = 32;
inline constexpr int kMaxMessages = 40;
/// @}

/// For each location, a place in its history.
struct alignas(16) View {
  std::uint8_t place[kMaxLocations];  ///< number of the message in the history

  /// Raises each place to that of `other`.
  void join(const View& other) {
    for (int i = 0; i < kMaxLocations; ++i) place[i] = std::max(place[i], other.place[i]);
  }
  /// Raises one place.
  void raise(int location, int to) {
    place[location] = std::max(place[location], static_cast<std::uint8_t>(to));
  }
};

/// An entry of a history.
struct Message {
  View view;             ///< what an acquire load learns
  std::uint64_t value;   ///< what a load returns
  std::uint64_t unused;  ///< padding
};

/// The knowledge of one thread.
struct ThreadViews {
  View current;     ///< limits its loads
  View acquirable;  ///< becomes `current` at an acquire fence
  View released;    ///< `current` at the last release fence
};

/// All shared memory.
struct Memory {
  std::uint8_t length[kMaxLocations];            ///< number of messages of each history
  View fenced;                                   ///< the common view of all seq_cst fences
  Message history[kMaxLocations][kMaxMessages];  ///< the histories, oldest message first

  /// The place of the newest message of a location.
  int newest(int location) const { return length[location] - 1; }
  /// The value of the newest message of a location.
  std::uint64_t newest_value(int location) const {
    return history[location][newest(location)].value;
  }
};

/// True if an operation of this order acquires, or releases.
/// @{
constexpr bool acquires(std::memory_order order) {
  return order == std::memory_order_acquire || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}
constexpr bool releases(std::memory_order order) {
  return order == std::memory_order_release || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}
/// @}

/// Reads the message at `place` and updates the views of the thread.
inline std::uint64_t read(const Memory& memory, ThreadViews& self, int location, int place,
                          bool acquire) {
  const auto& message = memory.history[location][place];
  self.current.raise(location, place);
  self.acquirable.raise(location, place);
  self.acquirable.join(message.view);
  if (acquire) self.current.join(message.view);
  return message.value;
}

/// Appends a message to the history of a location. `replaced`: the message that a read-modify-write
/// has read; null for a plain store.
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

/// A fence of an order below seq_cst, which affects only its thread.
inline void local_fence(ThreadViews& self, std::memory_order order) {
  if (acquires(order)) self.current = self.acquirable;
  if (releases(order)) self.released = self.current;
}

/// A fence of order seq_cst.
inline void seq_cst_fence(Memory& memory, ThreadViews& self) {
  self.current = self.acquirable;
  self.current.join(memory.fenced);
  memory.fenced = self.acquirable = self.released = self.current;
}

}  // namespace handcast::explorer
