#pragma once
#include <array>
#include <atomic>
#include <bitset>
#include <cstdint>

#include "ipc/ring/words.hpp"

/// The protocol of a ring, and nothing else: which word is read and written when, in which memory order. It knows no system
/// call and no message; the payload is touched through the caller's functions. README.md argues each order.
///
/// `Atomics` is RealAtomics in production; an explorer puts its own in. Nothing here needs a destructor.
namespace handcast::ipc {

inline constexpr int kNoSlot = -1;

/// The writer's half. One thread of one process at a time, by the writer lock.
template <class Atomics>
class WriterCore {
 public:
  explicit WriterCore(const ControlWords<Atomics>& words) : words_(words) {}

  /// Continues where a predecessor stopped, wherever that was. The writer lock must be held.
  void attach() {
    const auto head = Atomics::load(words_.head(), std::memory_order_acquire);
    auto newest = sequence_of(head);
    newest_ = newest != 0 && slot_of_head(head) < words_.slots() ? slot_of_head(head) : kNoSlot;
    auto last_epoch = Atomics::load(words_.epoch(), std::memory_order_acquire) & kEpochMask;
    for (int slot = 0; slot < words_.slots(); ++slot) {
      const auto state = mine_[slot] = Atomics::load(words_.state(slot), std::memory_order_acquire);
      if (epoch_of(state) > last_epoch) last_epoch = epoch_of(state);
      if (!holds_message(state) || sequence_of(state) <= newest) continue;
      newest = sequence_of(state);
      newest_ = slot;
    }
    if (newest > sequence_of(head)) Atomics::store(words_.head(), head_word(newest_, newest), std::memory_order_release);
    epoch_ = (last_epoch + 1) & kEpochMask;
    Atomics::store(words_.epoch(), epoch_, std::memory_order_release);
    next_ = following(newest);
    Atomics::wake(words_.head());  // always: the predecessor may have died between its message and its wake-up
  }

  /// A slot to write in; kNoSlot where all are leased, on loan or the newest. Wait-free.
  int loan() {
    auto busy = on_loan_ | leased_slots(std::memory_order_relaxed);  // a hint that spares marking in vain
    if (newest_ != kNoSlot) busy.set(newest_);                       // readers always find one message
    for (int slot = pick(busy); slot != kNoSlot; slot = pick(busy)) {
      const auto before = mine_[slot];
      Atomics::store(words_.state(slot), before | kWriting, std::memory_order_relaxed);
      Atomics::fence(std::memory_order_seq_cst);  // mark before scan (against a reader's lease), mark before payload
      if (!leased_slots(std::memory_order_acquire).test(slot)) {
        mine_[slot] = before | kWriting;
        on_loan_.set(slot);
        return slot;
      }
      Atomics::store(words_.state(slot), before, std::memory_order_release);  // untouched: the old message is valid again
      busy.set(slot);
    }
    return kNoSlot;
  }

  /// Makes the message in a loaned slot visible and wakes who waits.
  void publish(int slot) {
    mine_[slot] = state_word(epoch_, next_);
    Atomics::store(words_.state(slot), mine_[slot], std::memory_order_release);  // from here on the message exists
    Atomics::store(words_.head(), head_word(slot, next_), std::memory_order_release);
    newest_ = slot;
    next_ = following(next_);
    on_loan_.reset(slot);
    Atomics::fence(std::memory_order_seq_cst);  // head before flags, against wait()'s flag before head
    if (anyone_waits()) Atomics::wake(words_.head());
  }

  /// Gives a loaned slot back without a message. The old one never returns: its payload may be half overwritten.
  void abandon(int slot) {
    mine_[slot] = state_word(epoch_, 0);
    Atomics::store(words_.state(slot), mine_[slot], std::memory_order_release);
    on_loan_.reset(slot);
  }

  std::uint64_t epoch() const { return epoch_; }
  std::uint64_t next_sequence() const { return next_; }

 private:
  using SlotSet = std::bitset<kMaxSlots>;

  /// The most recently freed slot, which the caches still hold; the oldest where history is kept.
  int pick(const SlotSet& busy) const {
    int best = kNoSlot;
    for (int slot = 0; slot < words_.slots(); ++slot) {
      if (busy.test(slot)) continue;
      const bool older = best != kNoSlot && sequence_of(mine_[slot]) < sequence_of(mine_[best]);
      const bool newer = best != kNoSlot && sequence_of(mine_[slot]) > sequence_of(mine_[best]);
      if (best == kNoSlot || (words_.keep_history() ? older : newer)) best = slot;
    }
    return best;
  }

  SlotSet leased_slots(std::memory_order order) const {
    SlotSet leased;
    for (int row = 0; row < words_.rows(); ++row)
      for (int index = 0; index < kLeasesPerRow; ++index) {
        const int slot = slot_of_lease(Atomics::load(words_.lease(row, index), order));
        if (slot >= 0 && slot < words_.slots()) leased.set(slot);
      }
    return leased;
  }

  bool anyone_waits() const {
    for (int row = 0; row < words_.rows(); ++row)
      if (Atomics::load(words_.wait(row), std::memory_order_relaxed) & kWaiting) return true;
    return false;
  }

  ControlWords<Atomics> words_;
  std::uint64_t epoch_ = 0;
  std::uint64_t next_ = 1;
  int newest_ = kNoSlot;
  SlotSet on_loan_;
  std::array<std::uint64_t, kMaxSlots> mine_{};  ///< the state words as this writer left them: nobody else writes them
};

enum class Outcome {
  taken,      ///< a message was copied whole
  nothing,    ///< there is none (newer than the last one seen)
  contended,  ///< the writer overwrote each one while it was copied: try again
  corrupt,    ///< the words make no sense: something else writes to this memory
};

/// A message that was taken.
struct Taken {
  std::uint64_t sequence = 0;
  std::uint64_t epoch = 0;
};

/// A reader's half: one thread, one row. `Copy` is called as copy(slot) and must read the payload with relaxed atomic
/// loads; what it has read is worth something only after Outcome::taken.
template <class Atomics>
class ReaderCore {
 public:
  ReaderCore(const ControlWords<Atomics>& words, int row, std::uint64_t generation) : words_(words), row_(row), generation_(generation) {}

  /// A late reader's first message is the newest one; on a ring with history, the oldest one still there.
  void start() {
    auto first = sequence_of(Atomics::load(words_.head(), std::memory_order_acquire));
    for (int slot = 0; slot < words_.slots() && words_.keep_history(); ++slot) {
      const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
      if (holds_message(state) && sequence_of(state) < first) first = sequence_of(state);
    }
    seen_ = first == 0 ? 0 : first - 1;
  }

  bool something_new() const { return sequence_of(Atomics::load(words_.head(), std::memory_order_relaxed)) != seen_; }

  template <class Copy>
  Outcome latest(Copy&& copy, Taken& taken) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const auto head = Atomics::load(words_.head(), std::memory_order_acquire);
      if (const auto outcome = judge(head); outcome != Outcome::taken) return outcome;
      if (slot_of_head(head) >= words_.slots()) return Outcome::corrupt;
      if (copy_checked(slot_of_head(head), sequence_of(head), copy, taken)) return advance(taken);
    }
    return Outcome::contended;
  }

  /// The message after the last one seen; where that is gone, the oldest one after it that is still there.
  template <class Copy>
  Outcome next(Copy&& copy, Taken& taken) {
    auto wanted = seen_ + 1;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const auto head = Atomics::load(words_.head(), std::memory_order_acquire);
      if (const auto outcome = judge(head); outcome != Outcome::taken) return outcome;
      auto oldest = sequence_of(head);
      for (int slot = 0; slot < words_.slots(); ++slot) {
        const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
        if (!holds_message(state)) continue;
        if (sequence_of(state) == wanted && copy_checked(slot, wanted, copy, taken)) return advance(taken);
        if (sequence_of(state) > wanted && sequence_of(state) < oldest) oldest = sequence_of(state);
      }
      wanted = oldest;
    }
    return Outcome::contended;
  }

  /// The message whose origin, read by origin_of(slot) with a relaxed atomic load, is nearest to `wanted_ns`.
  template <class Origin, class Copy>
  Outcome nearest(std::int64_t wanted_ns, Origin&& origin_of, Copy&& copy, Taken& taken) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (sequence_of(Atomics::load(words_.head(), std::memory_order_acquire)) == 0) return Outcome::nothing;
      int best = kNoSlot;
      std::uint64_t best_sequence = 0, best_distance_ns = 0;
      for (int slot = 0; slot < words_.slots(); ++slot) {
        const auto state = Atomics::load(words_.state(slot), std::memory_order_acquire);
        if (!holds_message(state)) continue;
        const auto distance_ns = distance(origin_of(slot), wanted_ns);
        if (!unchanged(slot, state)) continue;
        if (best != kNoSlot && distance_ns > best_distance_ns) continue;
        if (best != kNoSlot && distance_ns == best_distance_ns && sequence_of(state) < best_sequence) continue;
        best = slot, best_sequence = sequence_of(state), best_distance_ns = distance_ns;
      }
      if (best != kNoSlot && copy_checked(best, best_sequence, copy, taken)) return Outcome::taken;
    }
    return Outcome::contended;
  }

  /// Sleeps until something new is there or `until_ns` is reached; may return early. The writer is asked to wake us.
  void wait(std::int64_t until_ns) {
    auto& flag = words_.wait(row_);
    const auto idle = free_word(generation_);
    Atomics::compare_exchange(flag, idle, idle | kWaiting, std::memory_order_relaxed);
    Atomics::fence(std::memory_order_seq_cst);  // flag before head, against publish()'s head before flags
    doze(until_ns);
    Atomics::compare_exchange(flag, idle | kWaiting, idle, std::memory_order_relaxed);
  }

  /// The same without asking: the writer makes no system call for us, and a message does not end the sleep.
  void doze(std::int64_t until_ns) {
    const auto head = Atomics::load(words_.head(), std::memory_order_relaxed);
    if (sequence_of(head) == seen_) Atomics::wait(words_.head(), head, until_ns);
  }

  std::uint64_t skipped() const { return skipped_; }

 private:
  static constexpr int kAttempts = 8;

  static std::uint64_t distance(std::int64_t a, std::int64_t b) {
    return a > b ? static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b)
                 : static_cast<std::uint64_t>(b) - static_cast<std::uint64_t>(a);
  }

  /// Outcome::taken: there is something to take. A head that went back is reported once, then followed.
  Outcome judge(std::uint64_t head) {
    if (sequence_of(head) == seen_) return Outcome::nothing;
    if (sequence_of(head) > seen_) return Outcome::taken;
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

  /// Whether what was read from the slot since its state was read belongs to that state: else it may be torn.
  bool unchanged(int slot, std::uint64_t state) const {
    Atomics::fence(std::memory_order_acquire);  // payload before the second look at the state
    return Atomics::load(words_.state(slot), std::memory_order_relaxed) == state;
  }

  Outcome advance(const Taken& taken) {
    skipped_ += taken.sequence - seen_ - 1;
    seen_ = taken.sequence;
    return Outcome::taken;
  }

  ControlWords<Atomics> words_;
  int row_;
  std::uint64_t generation_;
  std::uint64_t seen_ = 0;
  std::uint64_t skipped_ = 0;
};

/// Takes a row whose owner word was seen to be `before` (free, or of a process that is gone) for the process in `after`, and
/// clears what the predecessor left. False: somebody else was faster.
template <class Atomics>
bool claim_row(const ControlWords<Atomics>& words, int row, std::uint64_t before, std::uint64_t after) {
  if (!Atomics::compare_exchange(words.owner(row), before, after, std::memory_order_acq_rel)) return false;
  const auto clear = [&](typename Atomics::Word& word) {
    const auto free = free_word(generation_of(after));
    for (auto left = Atomics::load(word, std::memory_order_relaxed); left != free; left = Atomics::load(word, std::memory_order_relaxed))
      if (Atomics::compare_exchange(word, left, free, std::memory_order_acq_rel)) break;
  };
  clear(words.wait(row));
  for (int index = 0; index < kLeasesPerRow; ++index) clear(words.lease(row, index));
  return true;
}

/// Gives a row back; nothing happens where it was taken away in the meantime.
template <class Atomics>
void release_row(const ControlWords<Atomics>& words, int row, std::uint64_t owner) {
  Atomics::compare_exchange(words.owner(row), owner, free_word(generation_of(owner)), std::memory_order_release);
}

}  // namespace handcast::ipc
