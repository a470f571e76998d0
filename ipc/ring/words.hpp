// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "ipc/shm/layout.hpp"

/// The shared words of a ring: u64 each. Head, epoch and every state have a line of 128 bytes to
/// themselves; the words of a row, which one reader writes, share one.
///
///   head    slot:8 | -:8 | sequence:48          the newest message; a hint. Its low 32 bits are
///   the futex epoch   number of the last writer           (15 bits used) state   epoch:15 |
///   writing:1 | sequence:48  per slot; sequence 0: no message. A message exists by this word alone
///   owner   generation:16 | start:24 | pid:24   per row; pid 0: free
///   wait    generation:16 | -:47 | waiting:1    per row
///   lease   generation:16 | slot + 1:8 | sequence:40   per row; slot + 1 = 0: free
///
/// A sequence is given once in the life of a ring, over all its writers. Sequences, epochs and
/// generations (which count the owners of a row) wrap; the first two leave out zero, which means
/// none.
namespace handcast::ipc {

inline constexpr std::uint64_t kSequenceMask = (std::uint64_t{1} << 48) - 1;
inline constexpr std::uint64_t kWriting = std::uint64_t{1} << 48;
inline constexpr std::uint64_t kEpochMask = 0x7fff;
inline constexpr std::uint64_t kWaiting = 1;
inline constexpr std::uint64_t kPidMask = 0xff'ffff;  ///< Linux counts processes to 2^22

constexpr std::uint64_t sequence_of(std::uint64_t head_or_state) {
  return head_or_state & kSequenceMask;
}
constexpr std::uint64_t following(std::uint64_t sequence) {
  return sequence == kSequenceMask ? 1 : sequence + 1;
}
/// Whether `sequence` was given after `other`, across the wrap-around; any is later than none.
constexpr bool is_later(std::uint64_t sequence, std::uint64_t other) {
  if (sequence == 0 || other == 0) return sequence > other;
  return ((sequence - other) & kSequenceMask) - 1 < kSequenceMask / 2;
}
/// How many were given after `from`, up to `to`.
constexpr std::uint64_t given_between(std::uint64_t from, std::uint64_t to) {
  return (to - from - (to < from)) & kSequenceMask;
}
constexpr std::uint64_t following_epoch(std::uint64_t epoch) {
  return (epoch & kEpochMask) == kEpochMask ? 1 : (epoch & kEpochMask) + 1;
}

constexpr std::uint64_t head_word(int slot, std::uint64_t sequence) {
  return static_cast<std::uint64_t>(slot) << 56 | sequence;
}
constexpr int slot_of_head(std::uint64_t head) { return static_cast<int>(head >> 56); }

constexpr std::uint64_t state_word(std::uint64_t epoch, std::uint64_t sequence) {
  return epoch << 49 | sequence;
}
constexpr std::uint64_t epoch_of(std::uint64_t state) { return state >> 49; }
constexpr bool holds_message(std::uint64_t state) {
  return !(state & kWriting) && sequence_of(state) != 0;
}

constexpr std::uint64_t generation_of(std::uint64_t row_word) { return row_word >> 48; }
constexpr std::uint64_t free_word(std::uint64_t generation) {
  return (generation & 0xffff) << 48;
}  ///< of any word of a row
/// Whether a row's word is of an earlier owner than `generation`, across the wrap-around.
constexpr bool is_older(std::uint64_t row_word, std::uint64_t generation) {
  return static_cast<std::int16_t>(
             static_cast<std::uint16_t>(generation - generation_of(row_word))) > 0;
}
constexpr std::uint64_t owner_word(std::uint64_t generation, std::uint64_t start,
                                   std::uint64_t pid) {
  return (generation & 0xffff) << 48 | (start & kPidMask) << 24 | (pid & kPidMask);
}
constexpr std::uint64_t start_of_owner(std::uint64_t owner) { return owner >> 24 & kPidMask; }
constexpr std::uint64_t pid_of_owner(std::uint64_t owner) { return owner & kPidMask; }
constexpr std::uint64_t lease_word(std::uint64_t generation, int slot, std::uint64_t sequence) {
  return generation << 48 | static_cast<std::uint64_t>(slot + 1) << 40 |
         (sequence & ((std::uint64_t{1} << 40) - 1));
}
constexpr bool is_leased(std::uint64_t lease) { return lease & std::uint64_t{0xff} << 40; }
constexpr int slot_of_lease(std::uint64_t lease) {
  return static_cast<int>(lease >> 40 & 0xff) - 1;
}  ///< -1: free

/// Where the words of one ring lie. `Atomics` says what a word is and how it is read and written.
template <class Atomics>
class ControlWords {
 public:
  using Word = typename Atomics::Word;
  struct alignas(kLineBytes) Line {
    Word words[2 + kLeasesPerRow];  ///< of a row: owner, wait, leases; of every other line only the
                                    ///< first is used
  };

  /// `lines` has control_lines(slots, rows) elements.
  ControlWords(Line* lines, int slots, bool keep_history, int rows = kReaderRows)
      : lines_(lines), slots_(slots), rows_(rows), keep_history_(keep_history) {}

  int slots() const { return slots_; }
  int rows() const { return rows_; }
  bool keep_history() const { return keep_history_; }

  Word& head() const { return lines_[0].words[0]; }
  Word& epoch() const { return lines_[1].words[0]; }
  Word& state(int slot) const { return lines_[2 + slot].words[0]; }
  Word& owner(int row) const { return row_line(row).words[0]; }
  Word& wait(int row) const { return row_line(row).words[1]; }
  Word& lease(int row, int index) const { return row_line(row).words[2 + index]; }

 private:
  Line& row_line(int row) const { return lines_[2 + slots_ + row]; }

  Line* lines_;
  int slots_;
  int rows_;
  bool keep_history_;
};

}  // namespace handcast::ipc
