// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <bitset>
#include <cstdint>

#include "ipc/ring/words.hpp"

/// The protocol of a ring: which word is read and written when, and in which memory order. It makes
/// no system call and does not depend on the message type; payloads are accessed through functions
/// of the caller. README.md gives the reason for each order.
///
/// `Atomics` is RealAtomics in production; the explorer (tests/ipc/explorer) replaces it by a
/// model. For its sake, nothing here needs a destructor, and every function depends only on the
/// values that its operations returned.
namespace handcast::ipc {

inline constexpr int kNoSlot = -1;  ///< the slot number that means none

/// The writer's side of the protocol. One thread of one process at a time, which the writer lock
/// guarantees. `Capacity` is the largest number of slots.
template <class Atomics, int Capacity = kMaxSlots>
class WriterCore {
 public:
  /// Stores `words`; call attach() before anything else.
  explicit WriterCore(const ControlWords<Atomics>& words) : words_(words) {}

  /// Continues after the last message of the previous writer, which may have died at any step. The
  /// writer lock must be held.
  void attach() {
    const auto head = Atomics::load(words_.head(), std::memory_order_acquire);
    auto newest = sequence_of(head);
    newest_ = newest != 0 && slot_of_head(head) < words_.slots() ? slot_of_head(head) : kNoSlot;
    for (int slot = 0; slot < words_.slots(); ++slot) {
      const auto state = mine_[slot] = Atomics::load(words_.state(slot), std::memory_order_acquire);
      if (!holds_message(state) || !is_later(sequence_of(state), newest)) continue;
      newest = sequence_of(state);
      newest_ = slot;
    }
    if (newest != sequence_of(head))
      Atomics::store(words_.head(), head_word(newest_, newest), std::memory_order_release);
    epoch_ = following_epoch(Atomics::load(words_.epoch(), std::memory_order_acquire));
    // Before any state of this epoch is stored.
    Atomics::store(words_.epoch(), epoch_, std::memory_order_release);
    next_ = following(newest);
    // Always: the previous writer may have died between its message and its wake-up.
    Atomics::wake(words_.head());
  }

  /// A slot to write to; kNoSlot if each is leased, on loan or the newest. Wait-free.
  int loan() {
    auto taken = on_loan_;
    if (newest_ != kNoSlot) taken[index(newest_)] = true;  // readers always find one message
    auto busy = taken | leased_;  // slots that were leased last time probably still are
    for (int slot = pick(busy); slot != kNoSlot; slot = pick(busy |= leased_)) {
      mark(slot);
      // Orders the mark before the scan (pairs with lease_checked()) and before the payload.
      Atomics::fence(std::memory_order_seq_cst);
      leased_ = scan_leases();
      if (!leased_[index(slot)]) return keep(slot);
      restore(slot);
    }
    return leased_.none() ? kNoSlot : loan_after_marking_all(taken);
  }

  /// Makes the message in a loaned slot visible and wakes the waiting readers.
  void publish(int slot) {
    mine_[slot] = state_word(epoch_, next_);
    // From this store on the message exists.
    Atomics::store(words_.state(slot), mine_[slot], std::memory_order_release);
    Atomics::store(words_.head(), head_word(slot, next_), std::memory_order_release);
    newest_ = slot;
    next_ = following(next_);
    on_loan_.reset(slot);
    // Orders head before the flags; pairs with the fence in wait().
    Atomics::fence(std::memory_order_seq_cst);
    if (anyone_waits()) Atomics::wake(words_.head());
  }

  /// Returns a loaned slot without a message. The old message is not restored: its payload may be
  /// half overwritten.
  void abandon(int slot) {
    mine_[slot] = state_word(epoch_, 0);
    Atomics::store(words_.state(slot), mine_[slot], std::memory_order_release);
    on_loan_.reset(slot);
  }

  /// Number of this writer.
  std::uint64_t epoch() const { return epoch_; }
  /// Sequence of the next message that is published.
  std::uint64_t next_sequence() const { return next_; }

 private:
  using SlotSet = std::bitset<Capacity>;
  static constexpr std::size_t index(int slot) { return static_cast<std::size_t>(slot); }

  /// Readers that move from slot to slot may be met in each slot that is marked alone. So all
  /// candidates are marked before a single scan. For n leases it sees at most n slots, so of n + 1
  /// candidates one is free, however the readers move.
  int loan_after_marking_all(const SlotSet& taken) {
    for (int slot = 0; slot < words_.slots(); ++slot)
      if (!taken[index(slot)]) mark(slot);
    Atomics::fence(std::memory_order_seq_cst);  // as in loan()
    leased_ = scan_leases();
    const int free = pick(taken | leased_);
    for (int slot = 0; slot < words_.slots(); ++slot)
      if (!taken[index(slot)] && slot != free) restore(slot);
    return free == kNoSlot ? kNoSlot : keep(free);
  }

  void mark(int slot) {
    Atomics::store(words_.state(slot), mine_[slot] | kWriting, std::memory_order_relaxed);
  }
  /// Makes the old message valid again: its payload was not touched.
  void restore(int slot) {
    Atomics::store(words_.state(slot), mine_[slot], std::memory_order_release);
  }
  int keep(int marked) {
    mine_[marked] |= kWriting;
    on_loan_[index(marked)] = true;
    return marked;
  }

  /// The next slot in turn on a ring with history; otherwise the slot that was freed last, which is
  /// still in the caches.
  int pick(const SlotSet& busy) const {
    return words_.keep_history() ? pick_next(busy) : pick_warmest(busy);
  }

  int pick_next(const SlotSet& busy) const {
    for (int step = 1; step <= words_.slots(); ++step)
      if (const int slot = (newest_ + step) % words_.slots(); !busy[index(slot)]) return slot;
    return kNoSlot;
  }

  int pick_warmest(const SlotSet& busy) const {
    int best = kNoSlot;
    for (int slot = 0; slot < words_.slots(); ++slot)
      if (!busy[index(slot)] &&
          (best == kNoSlot || is_later(sequence_of(mine_[slot]), sequence_of(mine_[best]))))
        best = slot;
    return best;
  }

  /// The leased slots. Each load acquires what the end of a lease released: the last read of the
  /// payload by its reader.
  SlotSet scan_leases() const {
    SlotSet leased;
    // A copy stays in registers; a member is reloaded after each acquire.
    const auto words = words_;
    for (int row = 0; row < words.rows(); ++row)
      for (int which = 0; which < kLeasesPerRow; ++which) {
        const auto lease = Atomics::load(words.lease(row, which), std::memory_order_acquire);
        if (is_leased(lease) && slot_of_lease(lease) < words.slots())
          leased[index(slot_of_lease(lease))] = true;
      }
    return leased;
  }

  bool anyone_waits() const {
    const auto words = words_;
    for (int row = 0; row < words.rows(); ++row)
      if (Atomics::load(words.wait(row), std::memory_order_relaxed) & kWaiting) return true;
    return false;
  }

  ControlWords<Atomics> words_;
  std::uint64_t epoch_ = 0;
  std::uint64_t next_ = 1;
  int newest_ = kNoSlot;
  SlotSet on_loan_;
  SlotSet leased_;  ///< as of the last scan: a hint
  /// The state words as this writer stored them; no other process writes them.
  std::array<std::uint64_t, Capacity> mine_{};
};

/// The result of an attempt to take a message.
enum class Outcome {
  taken,      ///< A whole message was taken.
  nothing,    ///< There is no message, or none newer than the last one seen.
  contended,  ///< The writer overwrote each message while it was being taken. Try again.
  corrupt,    ///< The words are inconsistent: another program writes to this memory.
};

/// Identifies a message that was taken.
struct Taken {
  std::uint64_t sequence = 0;  ///< number of the message
  std::uint64_t epoch = 0;     ///< number of its writer
};

/// A lease on a message that is read in its slot. The slot is not written until the lease is
/// released.
struct Lease {
  int index = 0;           ///< number of the lease word in its row
  int slot = kNoSlot;      ///< the slot of the message
  std::uint64_t word = 0;  ///< the value that the lease word was set to
};

/// The reader's side of the protocol. One thread and one row; only release() may be called from any
/// thread.
///
/// next(), latest() and nearest() find a message. Their argument `take` decides how it is taken:
/// - copying(copy): copy(slot) reads the payload with relaxed atomic loads. The copy is valid only
///   after Outcome::taken.
/// - leasing(lease): the payload stays in its slot. `lease.index` is the lease word to use, which
///   must be free.
template <class Atomics>
class ReaderCore {
 public:
  /// Stores its arguments. `generation` is that of the row's owner word.
  ReaderCore(const ControlWords<Atomics>& words, int row, std::uint64_t generation)
      : words_(words), row_(row), generation_(generation) {}

  /// Sets the position so that the first message is the newest one, or on a ring with history the
  /// oldest one that is still there.
  void start() {
    auto first = sequence_of(Atomics::load(words_.head(), std::memory_order_acquire));
    for (int slot = 0; slot < words_.slots() && words_.keep_history(); ++slot) {
      const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
      if (holds_message(state) && is_later(first, sequence_of(state))) first = sequence_of(state);
    }
    seen_ = first == 0 ? 0 : first - 1;
  }

  /// True if a message after the last one seen may have been published.
  bool something_new() const {
    return sequence_of(Atomics::load(words_.head(), std::memory_order_relaxed)) != seen_;
  }

  /// The two ways to take a message: see the class. The argument must outlive the result.
  /// @{
  template <class Copy>
  auto copying(Copy& copy) const {
    return [this, &copy](int slot, std::uint64_t sequence, Taken& taken) {
      return copy_checked(slot, sequence, copy, taken);
    };
  }
  auto leasing(Lease& lease) const {
    return [this, &lease](int slot, std::uint64_t sequence, Taken& taken) {
      return lease_checked(slot, sequence, lease, taken);
    };
  }
  /// @}

  /// Takes the newest message, if it was not seen yet.
  template <class Take>
  Outcome latest(const Take& take, Taken& taken) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const auto head = Atomics::load(words_.head(), std::memory_order_acquire);
      if (const auto outcome = judge(head); outcome != Outcome::taken) return outcome;
      if (slot_of_head(head) >= words_.slots()) return Outcome::corrupt;
      if (take(slot_of_head(head), sequence_of(head), taken)) return advance(taken);
    }
    return Outcome::contended;
  }

  /// Takes the message after the last one seen; if that is gone, the oldest one after it that is
  /// still there.
  template <class Take>
  Outcome next(const Take& take, Taken& taken) {
    auto wanted = following(seen_);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const auto head = Atomics::load(words_.head(), std::memory_order_acquire);
      if (const auto outcome = judge(head); outcome != Outcome::taken) return outcome;
      auto oldest = sequence_of(head);
      for (int slot = 0; slot < words_.slots(); ++slot) {
        const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
        if (!holds_message(state)) continue;
        if (sequence_of(state) == wanted && take(slot, wanted, taken)) return advance(taken);
        if (is_later(sequence_of(state), wanted) && is_later(oldest, sequence_of(state)))
          oldest = sequence_of(state);
      }
      wanted = oldest;
    }
    return Outcome::contended;
  }

  /// Takes the message whose origin is nearest to `wanted_ns`, the newer one if two are equally
  /// near. origin_of(slot) must read the origin with a relaxed atomic load. The message does not
  /// count as seen.
  template <class Origin, class Take>
  Outcome nearest(std::int64_t wanted_ns, const Origin& origin_of, const Take& take,
                  Taken& taken) const {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (sequence_of(Atomics::load(words_.head(), std::memory_order_acquire)) == 0)
        return Outcome::nothing;
      int best = kNoSlot;
      std::uint64_t best_sequence = 0, best_distance_ns = 0;
      for (int slot = 0; slot < words_.slots(); ++slot) {
        const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
        if (!holds_message(state)) continue;
        const auto distance_ns = distance(origin_of(slot), wanted_ns);
        if (!unchanged(slot, state)) continue;
        if (best != kNoSlot && distance_ns > best_distance_ns) continue;
        if (best != kNoSlot && distance_ns == best_distance_ns &&
            is_later(best_sequence, sequence_of(state)))
          continue;
        best = slot, best_sequence = sequence_of(state), best_distance_ns = distance_ns;
      }
      if (best != kNoSlot && take(best, best_sequence, taken)) return Outcome::taken;
    }
    return Outcome::contended;
  }

  /// Ends a lease. Returns false if the lease was taken away, which happens only to a process that
  /// was mistaken for dead: the data that was read is invalid then. Any thread.
  bool release(const Lease& lease) const {
    return Atomics::compare_exchange(words_.lease(row_, lease.index), lease.word,
                                     free_word(generation_), std::memory_order_release);
  }
  /// The number of a free lease word; -1 if all are in use.
  int free_lease() const {
    for (int index = 0; index < kLeasesPerRow; ++index)
      if (Atomics::load(words_.lease(row_, index), std::memory_order_relaxed) ==
          free_word(generation_))
        return index;
    return -1;
  }

  /// Counts all messages so far as seen.
  void catch_up() { seen_ = sequence_of(Atomics::load(words_.head(), std::memory_order_acquire)); }

  /// Sleeps until there is a new message or `until_ns` (CLOCK_MONOTONIC) is reached; may return
  /// early. Requests a wake-up from the writer.
  void wait(std::int64_t until_ns) {
    auto& flag = words_.wait(row_);
    const auto idle = free_word(generation_);
    Atomics::compare_exchange(flag, idle, idle | kWaiting, std::memory_order_relaxed);
    // Orders the flag before head; pairs with the fence in publish().
    Atomics::fence(std::memory_order_seq_cst);
    doze(until_ns);
    Atomics::compare_exchange(flag, idle | kWaiting, idle, std::memory_order_relaxed);
  }

  /// Like wait(), but requests no wake-up: the writer makes no system call, and a new message need
  /// not end the sleep.
  void doze(std::int64_t until_ns) {
    const auto head = Atomics::load(words_.head(), std::memory_order_relaxed);
    if (sequence_of(head) == seen_) Atomics::wait(words_.head(), head, until_ns);
  }

  /// Number of messages that were overwritten or passed over.
  std::uint64_t skipped() const { return skipped_; }
  /// Sequence of the last message seen.
  std::uint64_t seen() const { return seen_; }

 private:
  static constexpr int kAttempts = 8;

  static std::uint64_t distance(std::int64_t a, std::int64_t b) {
    return a > b ? static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b)
                 : static_cast<std::uint64_t>(b) - static_cast<std::uint64_t>(a);
  }

  /// Outcome::taken if there is a message to take. A head that went backwards is reported as
  /// corrupt once, then accepted.
  Outcome judge(std::uint64_t head) {
    if (sequence_of(head) == seen_) return Outcome::nothing;
    if (is_later(sequence_of(head), seen_)) return Outcome::taken;
    seen_ = sequence_of(head);
    return Outcome::corrupt;
  }

  template <class Copy>
  bool copy_checked(int slot, std::uint64_t sequence, Copy& copy, Taken& taken) const {
    const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
    if (!holds_message(state) || sequence_of(state) != sequence) return false;
    copy(slot);
    if (!unchanged(slot, state)) return false;
    taken = {sequence, epoch_of(state)};
    return true;
  }

  bool lease_checked(int slot, std::uint64_t sequence, Lease& lease, Taken& taken) const {
    auto& word = words_.lease(row_, lease.index);
    lease.slot = slot;
    lease.word = lease_word(generation_, slot, sequence);
    if (!Atomics::compare_exchange(word, free_word(generation_), lease.word,
                                   std::memory_order_relaxed))
      return false;
    // Orders the lease before the state; pairs with the fence in loan().
    Atomics::fence(std::memory_order_seq_cst);
    const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
    if (holds_message(state) && sequence_of(state) == sequence) {
      taken = {sequence, epoch_of(state)};
      return true;
    }
    release(lease);
    return false;
  }

  /// True if the data that was read from the slot since `state` was loaded belongs to that state;
  /// otherwise it may be torn.
  bool unchanged(int slot, std::uint64_t state) const {
    Atomics::fence(std::memory_order_acquire);  // payload before the second load of the state
    return Atomics::load(words_.state(slot), std::memory_order_relaxed) == state;
  }

  Outcome advance(const Taken& taken) {
    skipped_ += given_between(seen_, taken.sequence) - 1;
    seen_ = taken.sequence;
    return Outcome::taken;
  }

  ControlWords<Atomics> words_;
  int row_;
  std::uint64_t generation_;
  std::uint64_t seen_ = 0;
  std::uint64_t skipped_ = 0;
};

/// Changes the owner of a row from `before` (free, or a process that is gone) to `after`, which
/// must be of a later generation: the owner word of the process that claims the row, or free_word()
/// to free the row of a dead process. Clears the wait word and the leases. Returns false if another
/// process was faster.
///
/// A word is cleared only while it is of an earlier generation. So the next process completes the
/// work of one that stopped half way, and a slow one cannot touch words that the next owner has
/// begun to use.
template <class Atomics>
bool claim_row(const ControlWords<Atomics>& words, int row, std::uint64_t before,
               std::uint64_t after) {
  if (!Atomics::compare_exchange(words.owner(row), before, after, std::memory_order_acq_rel))
    return false;
  const auto generation = generation_of(after);
  const auto clear = [&](typename Atomics::Word& word) {
    for (auto left = Atomics::load(word, std::memory_order_relaxed); is_older(left, generation);
         left = Atomics::load(word, std::memory_order_relaxed))
      if (Atomics::compare_exchange(word, left, free_word(generation), std::memory_order_acq_rel))
        break;
  };
  clear(words.wait(row));
  for (int index = 0; index < kLeasesPerRow; ++index) clear(words.lease(row, index));
  return true;
}

/// Releases a row. Has no effect if the row was taken away meanwhile.
template <class Atomics>
void release_row(const ControlWords<Atomics>& words, int row, std::uint64_t owner) {
  Atomics::compare_exchange(words.owner(row), owner, free_word(generation_of(owner)),
                            std::memory_order_release);
}

}  // namespace handcast::ipc
