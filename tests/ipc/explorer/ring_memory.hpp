// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "tests/ipc/explorer/model_atomics.hpp"

namespace handcast::explorer {

inline constexpr int kModelRows = 2;
inline constexpr int kModelSlots = 4;
inline constexpr int kMaxPayloadWords = 2;

struct RingShape {
  int slots = 3;
  bool keep_history = false;
  /// One is enough: words beyond it can only make a reader notice more, since a copy that holds one
  /// new word shows the mark.
  int payload_words = 1;
  int messages = 1;  ///< published before the story begins, known to all
  std::uint64_t first_sequence = 1;
  std::uint64_t first_epoch = 1;
  std::uint64_t generation = 1;  ///< of the rows' first owners
};

/// What lies in the memory of the ring that is being explored. One at a time: the threads' code
/// reaches it without locals.
class RingMemory {
 public:
  explicit RingMemory(const RingShape& shape);

  const RingShape& shape() const { return shape_; }
  Words words() { return {lines_, shape_.slots, shape_.keep_history, kModelRows}; }
  int payload(int slot, int word) const { return payload_[slot][word]; }
  /// Counts the plain reads of a slot by a thread; -1 where it never leases.
  int read_count(int slot, int thread) const { return read_counts_[slot][thread]; }
  const std::vector<int>& read_counts(int slot) const { return counted_[slot]; }
  void count_reads_of(int thread);

  Set words_of_writer() const;      ///< what a writer stores
  Set words_of_row(int row) const;  ///< what a reader or a recoverer of that row changes
  Set lease_words(int row) const;
  Set everything() const { return ~Set{0}; }

 private:
  RingShape shape_;
  Words::Line lines_[2 + kModelSlots + kModelRows];
  int payload_[kModelSlots][kMaxPayloadWords]{};
  int read_counts_[kModelSlots][kMaxThreads];
  std::vector<int> counted_[kModelSlots];
};

inline RingMemory* ring = nullptr;

/// The one payload that belongs to a message.
constexpr std::uint64_t payload_of(std::uint64_t sequence, std::uint64_t epoch) {
  return sequence << 15 | epoch;
}
constexpr std::int64_t origin_of_payload(std::uint64_t payload) {
  return static_cast<std::int64_t>(payload >> 15);
}

}  // namespace handcast::explorer
