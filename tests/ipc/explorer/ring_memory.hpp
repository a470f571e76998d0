// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "tests/ipc/explorer/model_atomics.hpp"

namespace handcast::explorer {

/// The sizes of the model: reader rows, and the largest numbers of slots and of payload words.
/// @{
inline constexpr int kModelRows = 2;
inline constexpr int kModelSlots = 4;
inline constexpr int kMaxPayloadWords = 2;
/// @}

/// The ring that is explored.
struct RingShape {
  int slots = 3;              ///< number of slots
  bool keep_history = false;  ///< RingSpec::keep_history
  /// Number of words of a payload. One is enough: a copy with one new word makes its reader see the
  /// mark, and more words only add further chances.
  int payload_words = 1;
  int messages = 1;  ///< messages published before the story begins, known to all threads
  std::uint64_t first_sequence = 1;  ///< sequence of the first message
  std::uint64_t first_epoch = 1;     ///< epoch of the first writer
  std::uint64_t generation = 1;      ///< generation of the first owners of the rows
};

/// The words of the ring that is explored, as locations of the machine. Only one object at a time.
class RingMemory {
 public:
  /// Adds the locations to the machine.
  explicit RingMemory(const RingShape& shape);

  /// The ring.
  const RingShape& shape() const { return shape_; }
  /// Its control words.
  Words words() { return {lines_, shape_.slots, shape_.keep_history, kModelRows}; }
  /// The location of a word of a payload.
  int payload(int slot, int word) const { return payload_[slot][word]; }
  /// The location that counts the plain reads of a slot by a thread; -1 if it takes no leases.
  int read_count(int slot, int thread) const { return read_counts_[slot][thread]; }
  /// The read counts of a slot of all threads that take leases.
  const std::vector<int>& read_counts(int slot) const { return counted_[slot]; }
  /// Adds the read counts of a thread.
  void count_reads_of(int thread);

  /// The words that a writer stores.
  Set words_of_writer() const;
  /// The words that a reader or recoverer of this row changes.
  Set words_of_row(int row) const;
  /// The lease words of a row.
  Set lease_words(int row) const;
  /// All words.
  Set everything() const { return ~Set{0}; }

 private:
  RingShape shape_;
  Words::Line lines_[2 + kModelSlots + kModelRows];
  int payload_[kModelSlots][kMaxPayloadWords]{};
  int read_counts_[kModelSlots][kMaxThreads];
  std::vector<int> counted_[kModelSlots];
};

/// The ring that is explored. It is global because the code of the threads has only its locals.
inline RingMemory* ring = nullptr;

/// The payload of a message, which no other message has.
constexpr std::uint64_t payload_of(std::uint64_t sequence, std::uint64_t epoch) {
  return sequence << 15 | epoch;
}
/// The origin of a message with this payload: its sequence.
constexpr std::int64_t origin_of_payload(std::uint64_t payload) {
  return static_cast<std::int64_t>(payload >> 15);
}

}  // namespace handcast::explorer
