// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "ipc/shm/layout.hpp"

/// The control words of a ring, 64 bits each. `head`, `epoch` and each `state` have a line of 128
/// bytes to themselves; the words of a row, which one reader writes, share one line.
///
///     head    slot:8 | -:8 | sequence:48                the newest message; a hint. The low 32
///                                                       bits are the futex
///     epoch   -:49 | epoch:15                           number of the last writer
///     state   epoch:15 | writing:1 | sequence:48        one per slot; sequence 0: no message. A
///                                                       message exists by this word alone
///     owner   generation:16 | start:24 | pid:24         one per row; pid 0: free
///     wait    generation:16 | -:47 | waiting:1          one per row
///     lease   generation:16 | slot + 1:8 | sequence:40  two per row; slot + 1 = 0: free
///
/// A sequence is given once in the life of a ring, across all its writers. A generation counts the
/// owners of a row. Sequences, epochs and generations wrap around; sequences and epochs skip zero,
/// which means none.
namespace handcast::ipc {

inline constexpr std::uint64_t kSequenceMask = (std::uint64_t{1} << 48) - 1;  ///< of head, state
inline constexpr std::uint64_t kWriting = std::uint64_t{1} << 48;  ///< of a state: being written
inline constexpr std::uint64_t kEpochMask = 0x7fff;                ///< of the epoch word
inline constexpr std::uint64_t kWaiting = 1;          ///< of a wait word: the reader sleeps
inline constexpr std::uint64_t kPidMask = 0xff'ffff;  ///< pids of Linux are below 2^22

/// The sequence in a head or state word; 0: none.
constexpr std::uint64_t sequence_of(std::uint64_t head_or_state) {
  return head_or_state & kSequenceMask;
}
/// The sequence after `sequence`.
constexpr std::uint64_t following(std::uint64_t sequence) {
  return sequence == kSequenceMask ? 1 : sequence + 1;
}
/// True if `sequence` was given after `other`, also across the wrap-around. Any sequence is later
/// than none (0).
constexpr bool is_later(std::uint64_t sequence, std::uint64_t other) {
  if (sequence == 0 || other == 0) return sequence > other;
  return ((sequence - other) & kSequenceMask) - 1 < kSequenceMask / 2;
}
/// The number of sequences that were given after `from`, up to and including `to`.
constexpr std::uint64_t given_between(std::uint64_t from, std::uint64_t to) {
  return (to - from - (to < from)) & kSequenceMask;
}
/// The epoch after `epoch`.
constexpr std::uint64_t following_epoch(std::uint64_t epoch) {
  return (epoch & kEpochMask) == kEpochMask ? 1 : (epoch & kEpochMask) + 1;
}

/// Builds a head word.
constexpr std::uint64_t head_word(int slot, std::uint64_t sequence) {
  return static_cast<std::uint64_t>(slot) << 56 | sequence;
}
/// The slot in a head word, 0 .. 255: check it against the number of slots.
constexpr int slot_of_head(std::uint64_t head) { return static_cast<int>(head >> 56); }

/// Builds the state word of a slot that holds a message (or none, if `sequence` is 0).
constexpr std::uint64_t state_word(std::uint64_t epoch, std::uint64_t sequence) {
  return epoch << 49 | sequence;
}
/// The epoch in a state word.
constexpr std::uint64_t epoch_of(std::uint64_t state) { return state >> 49; }
/// True if the slot with this state word holds a message and is not being written.
constexpr bool holds_message(std::uint64_t state) {
  return !(state & kWriting) && sequence_of(state) != 0;
}

/// The generation in any word of a row.
constexpr std::uint64_t generation_of(std::uint64_t row_word) { return row_word >> 48; }
/// The free or idle value of any word of a row.
constexpr std::uint64_t free_word(std::uint64_t generation) { return (generation & 0xffff) << 48; }
/// True if a word of a row belongs to an earlier owner than `generation`, also across the
/// wrap-around.
constexpr bool is_older(std::uint64_t row_word, std::uint64_t generation) {
  return static_cast<std::int16_t>(
             static_cast<std::uint16_t>(generation - generation_of(row_word))) > 0;
}
/// Builds an owner word. `start` is the start time of the process in clock ticks since boot; only
/// 24 bits of `start` and `pid` are kept.
constexpr std::uint64_t owner_word(std::uint64_t generation, std::uint64_t start,
                                   std::uint64_t pid) {
  return (generation & 0xffff) << 48 | (start & kPidMask) << 24 | (pid & kPidMask);
}
/// The start time (low 24 bits) or the pid in an owner word; pid 0: the row is free.
/// @{
constexpr std::uint64_t start_of_owner(std::uint64_t owner) { return owner >> 24 & kPidMask; }
constexpr std::uint64_t pid_of_owner(std::uint64_t owner) { return owner & kPidMask; }
/// @}
/// Builds the word of a lease on a slot with a message; only 40 bits of `sequence` are kept.
constexpr std::uint64_t lease_word(std::uint64_t generation, int slot, std::uint64_t sequence) {
  return generation << 48 | static_cast<std::uint64_t>(slot + 1) << 40 |
         (sequence & ((std::uint64_t{1} << 40) - 1));
}
/// True if a lease word is in use.
constexpr bool is_leased(std::uint64_t lease) { return lease & std::uint64_t{0xff} << 40; }
/// The slot in a lease word; -1: free.
constexpr int slot_of_lease(std::uint64_t lease) {
  return static_cast<int>(lease >> 40 & 0xff) - 1;
}

/// The control words of one ring in memory. `Atomics` defines the type of a word and how it is read
/// and written (RealAtomics).
template <class Atomics>
class ControlWords {
 public:
  using Word = typename Atomics::Word;  ///< one word
  /// One line of control words.
  struct alignas(kLineBytes) Line {
    /// In the line of a row: owner, wait, leases. In any other line only the first word is used.
    Word words[2 + kLeasesPerRow];
  };

  /// `lines` points to control_lines(slots, rows) lines, which must outlive this object.
  ControlWords(Line* lines, int slots, bool keep_history, int rows = kReaderRows)
      : lines_(lines), slots_(slots), rows_(rows), keep_history_(keep_history) {}

  /// Number of slots, and of reader rows.
  /// @{
  int slots() const { return slots_; }
  int rows() const { return rows_; }
  /// @}
  /// See RingSpec::keep_history.
  bool keep_history() const { return keep_history_; }

  /// The words described at the top of this file. The arguments must be in range.
  /// @{
  Word& head() const { return lines_[0].words[0]; }
  Word& epoch() const { return lines_[1].words[0]; }
  Word& state(int slot) const { return lines_[2 + slot].words[0]; }
  Word& owner(int row) const { return row_line(row).words[0]; }
  Word& wait(int row) const { return row_line(row).words[1]; }
  Word& lease(int row, int index) const { return row_line(row).words[2 + index]; }
  /// @}

 private:
  Line& row_line(int row) const { return lines_[2 + slots_ + row]; }

  Line* lines_;
  int slots_;
  int rows_;
  bool keep_history_;
};

}  // namespace handcast::ipc
