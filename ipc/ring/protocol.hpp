// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <bitset>
#include <cstdint>

#include "ipc/ring/words.hpp"

/// The protocol of a ring, and nothing else: which word is read and written when, in which memory
/// order. It knows no system call and no message; the payload is touched through the caller's
/// functions. README.md argues each order.
///
/// `Atomics` is RealAtomics in production; the explorer (tests/ipc/explorer) puts its own in.
/// Nothing here needs a destructor, and no function of it depends on anything but the values its
/// operations gave back.
namespace handcast::ipc {

inline constexpr int kNoSlot = -1;

/// The writer's half. One thread of one process at a time, by the writer lock. `Capacity`: the most
/// slots it can serve.
template <class Atomics, int Capacity = kMaxSlots>
class WriterCore {
 public:
  explicit WriterCore(const ControlWords<Atomics>& words) : words_(words) {}

  /// Continues where a predecessor stopped, wherever that was. The writer lock must be held.
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
    Atomics::store(words_.epoch(), epoch_,
                   std::memory_order_release);  // before any state of this epoch
    next_ = following(newest);
    Atomics::wake(
        words_
            .head());  // always: the predecessor may have died between its message and its wake-up
  }

  /// A slot to write in; kNoSlot where all are leased, on loan or the newest. Wait-free.
  int loan() {
    auto taken = on_loan_;
    if (newest_ != kNoSlot) taken[index(newest_)] = true;  // readers always find one message
    auto busy = taken | leased_;  // those that were leased last time probably still are
    for (int slot = pick(busy); slot != kNoSlot; slot = pick(busy |= leased_)) {
      mark(slot);
      Atomics::fence(std::memory_order_seq_cst);  // mark before scan (against a reader's lease),
                                                  // mark before payload
      leased_ = scan_leases();
      if (!leased_[index(slot)]) return keep(slot);
      restore(slot);
    }
    return leased_.none() ? kNoSlot : loan_after_marking_all(taken);
  }

  /// Makes the message in a loaned slot visible and wakes who waits.
  void publish(int slot) {
    mine_[slot] = state_word(epoch_, next_);
    Atomics::store(words_.state(slot), mine_[slot],
                   std::memory_order_release);  // from here on the message exists
    Atomics::store(words_.head(), head_word(slot, next_), std::memory_order_release);
    newest_ = slot;
    next_ = following(next_);
    on_loan_.reset(slot);
    Atomics::fence(
        std::memory_order_seq_cst);  // head before flags, against wait()'s flag before head
    if (anyone_waits()) Atomics::wake(words_.head());
  }

  /// Gives a loaned slot back without a message. The old one never returns: its payload may be half
  /// overwritten.
  void abandon(int slot) {
    mine_[slot] = state_word(epoch_, 0);
    Atomics::store(words_.state(slot), mine_[slot], std::memory_order_release);
    on_loan_.reset(slot);
  }

  std::uint64_t epoch() const { return epoch_; }
  std::uint64_t next_sequence() const { return next_; }

 private:
  using SlotSet = std::bitset<Capacity>;
  static constexpr std::size_t index(int slot) { return static_cast<std::size_t>(slot); }

  /// Readers that go from slot to slot may each time be met in the one that was just marked. So all
  /// are marked before one scan: of n leases it sees at most n slots, so that one of n + 1
  /// candidates is free, however the readers move.
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
  /// The payload is untouched: the old message is valid again.
  void restore(int slot) {
    Atomics::store(words_.state(slot), mine_[slot], std::memory_order_release);
  }
  int keep(int marked) {
    mine_[marked] |= kWriting;
    on_loan_[index(marked)] = true;
    return marked;
  }

  /// Where history is kept the slots go round; else the most recently freed one, which the caches
  /// still hold.
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

  /// Acquires what the end of each lease released: the reader's last look at the payload.
  SlotSet scan_leases() const {
    SlotSet leased;
    const auto words = words_;  // kept in registers, which a member is not across an acquire
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
  std::array<std::uint64_t, Capacity>
      mine_{};  ///< the state words as this writer left them: nobody else writes them
};

enum class Outcome {
  taken,      ///< a message was copied whole
  nothing,    ///< there is none (newer than the last one seen)
  contended,  ///< the writer overwrote each one while it was being taken: try again
  corrupt,    ///< the words make no sense: something else writes to this memory
};

/// A message that was taken.
struct Taken {
  std::uint64_t sequence = 0;
  std::uint64_t epoch = 0;
};

/// A message that is read where it lies. Its slot is not written until it is released.
struct Lease {
  int index = 0;  ///< which of the row's lease words
  int slot = kNoSlot;
  std::uint64_t word = 0;  ///< what the lease word was set to
};

/// A reader's half: one thread, one row (release() alone may be called from any thread). The verbs
/// find a message; what happens to it is the caller's `take`, one of
///   copying(copy)    copy(slot) reads the payload with relaxed atomic loads; worth something only
///   after Outcome::taken leasing(lease)   leaves the payload where it is; `lease.index` says with
///   which word, which must be free
template <class Atomics>
class ReaderCore {
 public:
  ReaderCore(const ControlWords<Atomics>& words, int row, std::uint64_t generation)
      : words_(words), row_(row), generation_(generation) {}

  /// A late reader's first message is the newest one; on a ring with history, the oldest one still
  /// there.
  void start() {
    auto first = sequence_of(Atomics::load(words_.head(), std::memory_order_acquire));
    for (int slot = 0; slot < words_.slots() && words_.keep_history(); ++slot) {
      const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
      if (holds_message(state) && is_later(first, sequence_of(state))) first = sequence_of(state);
    }
    seen_ = first == 0 ? 0 : first - 1;
  }

  bool something_new() const {
    return sequence_of(Atomics::load(words_.head(), std::memory_order_relaxed)) != seen_;
  }

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

  /// The message after the last one seen; where that is gone, the oldest one after it that is still
  /// there.
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

  /// The message whose origin, read by origin_of(slot) with a relaxed atomic load, is nearest to
  /// `wanted_ns`.
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

  /// False where the lease was taken away, which only happens to a process that was taken for dead:
  /// what was read is worth nothing.
  bool release(const Lease& lease) const {
    return Atomics::compare_exchange(words_.lease(row_, lease.index), lease.word,
                                     free_word(generation_), std::memory_order_release);
  }
  /// A lease word that is free; -1 where all are in use.
  int free_lease() const {
    for (int index = 0; index < kLeasesPerRow; ++index)
      if (Atomics::load(words_.lease(row_, index), std::memory_order_relaxed) ==
          free_word(generation_))
        return index;
    return -1;
  }

  /// Counts everything up to now as seen.
  void catch_up() { seen_ = sequence_of(Atomics::load(words_.head(), std::memory_order_acquire)); }

  /// Sleeps until something new is there or `until_ns` is reached; may return early. The writer is
  /// asked to wake us.
  void wait(std::int64_t until_ns) {
    auto& flag = words_.wait(row_);
    const auto idle = free_word(generation_);
    Atomics::compare_exchange(flag, idle, idle | kWaiting, std::memory_order_relaxed);
    Atomics::fence(
        std::memory_order_seq_cst);  // flag before head, against publish()'s head before flags
    doze(until_ns);
    Atomics::compare_exchange(flag, idle | kWaiting, idle, std::memory_order_relaxed);
  }

  /// The same without asking: the writer makes no system call for us, and a message does not end
  /// the sleep.
  void doze(std::int64_t until_ns) {
    const auto head = Atomics::load(words_.head(), std::memory_order_relaxed);
    if (sequence_of(head) == seen_) Atomics::wait(words_.head(), head, until_ns);
  }

  std::uint64_t skipped() const { return skipped_; }
  std::uint64_t seen() const { return seen_; }

 private:
  static constexpr int kAttempts = 8;

  static std::uint64_t distance(std::int64_t a, std::int64_t b) {
    return a > b ? static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b)
                 : static_cast<std::uint64_t>(b) - static_cast<std::uint64_t>(a);
  }

  /// Outcome::taken: there is something to take. A head that went back is reported once, then
  /// followed.
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
    Atomics::fence(
        std::memory_order_seq_cst);  // lease before state, against loan()'s mark before scan
    const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
    if (holds_message(state) && sequence_of(state) == sequence) {
      taken = {sequence, epoch_of(state)};
      return true;
    }
    release(lease);
    return false;
  }

  /// Whether what was read from the slot since its state was read belongs to that state: else it
  /// may be torn.
  bool unchanged(int slot, std::uint64_t state) const {
    Atomics::fence(std::memory_order_acquire);  // payload before the second look at the state
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

/// Gives a row whose owner word was seen to be `before` (free, or of a process that is gone) to
/// `after`, of a later generation: a process that takes it, or free_word() where a dead one's
/// leases are only to be cleared. False: somebody else was faster.
///
/// A word is cleared only while it is of an earlier generation, so a recoverer that stops half way
/// is made good by the next one, and one that is slow cannot touch what the row's next owner has
/// begun.
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

/// Gives a row back; nothing happens where it was taken away in the meantime.
template <class Atomics>
void release_row(const ControlWords<Atomics>& words, int row, std::uint64_t owner) {
  Atomics::compare_exchange(words.owner(row), owner, free_word(generation_of(owner)),
                            std::memory_order_release);
}

}  // namespace handcast::ipc
