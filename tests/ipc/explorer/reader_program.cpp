// SPDX-License-Identifier: Apache-2.0
#include "tests/ipc/explorer/reader_program.hpp"

#include <utility>

namespace handcast::explorer {
namespace {

using ipc::Outcome;

struct Got {
  Outcome outcome = Outcome::nothing;
  ipc::Taken taken;
  std::uint64_t payload = 0;
  bool is_whole = true;
};

std::uint64_t top_sequence() {
  return ipc::sequence_of(machine->state().memory.newest_value(ring->words().head().location));
}

/// Copies the payload word by word with relaxed loads.
void copy_payload(int slot, Got& got) {
  got.payload = machine->load(ring->payload(slot, 0), std::memory_order_relaxed);
  got.is_whole = true;
  for (int word = 1; word < ring->shape().payload_words; ++word)
    got.is_whole &=
        machine->load(ring->payload(slot, word), std::memory_order_relaxed) == got.payload;
}

std::uint64_t read_leased(const ReaderLocals& self, int slot) {
  const int location = ring->payload(slot, 0);
  if (self.reading.hold == Hold::doubted_lease)
    return machine->load(location, std::memory_order_relaxed);
  return machine->plain_read(location, ring->read_count(slot, machine->thread()));
}

template <class Take>
Outcome apply_verb(ReaderLocals& self, const Take& take, ipc::Taken& taken) {
  const auto origin_of = [](int slot) {
    return origin_of_payload(machine->load(ring->payload(slot, 0), std::memory_order_relaxed));
  };
  switch (self.reading.verb) {
    case Verb::latest:
      return self.core.latest(take, taken);
    case Verb::next:
      return self.core.next(take, taken);
    default:
      return self.core.nearest(static_cast<std::int64_t>(ring->shape().first_sequence), origin_of,
                               take, taken);
  }
}

Got take_copy(ReaderLocals& self) {
  Got got;
  const auto copy = [&got](int slot) { copy_payload(slot, got); };
  got.outcome = apply_verb(self, self.core.copying(copy), got.taken);
  return got;
}

Got take_lease(ReaderLocals& self) {
  Got got;
  auto& lease = self.leases[self.held];
  lease.index = self.core.free_lease();
  machine->check(lease.index >= 0 || self.reading.hold == Hold::doubted_lease,
                 "a reader has no free lease although it holds less than it may");
  if (lease.index < 0) return {Outcome::contended};
  got.outcome = apply_verb(self, self.core.leasing(lease), got.taken);
  if (got.outcome != Outcome::taken) return got;
  got.payload = read_leased(self, lease.slot);
  self.payloads[self.held++] = payload_of(got.taken.sequence, got.taken.epoch);
  return got;
}

/// Checks the properties that a reader relies on.
void judge(const ReaderLocals& self, const Got& got, std::uint64_t seen_before) {
  machine->check(got.outcome != Outcome::corrupt, "the control words are inconsistent to a reader");
  if (got.outcome == Outcome::taken && self.reading.hold != Hold::doubted_lease)
    machine->check(got.is_whole && got.payload == payload_of(got.taken.sequence, got.taken.epoch),
                   "a torn or wrong message is accepted");
  const bool in_order = self.reading.verb != Verb::nearest;
  if (got.outcome == Outcome::taken && in_order)
    machine->check(got.taken.sequence > seen_before, "the sequence goes backwards");
  // A reader may fail only because of newer messages, not because the writer stands still or is
  // dead.
  if (got.outcome == Outcome::contended && self.reading.hold != Hold::doubted_lease)
    machine->check(top_sequence() > seen_before + 1,
                   "a reader starves although nothing newer was published");
  if (got.outcome == Outcome::nothing)
    machine->check(seen_before != 0, "a late reader finds no message although there always is one");
}

/// Releases the oldest lease. Its payload must still be the one that was taken.
bool release_oldest(ReaderLocals& self) {
  const auto lease = self.leases[0];
  const bool is_unchanged = read_leased(self, lease.slot) == self.payloads[0];
  const bool was_mine = self.core.release(lease);
  machine->check(!was_mine || is_unchanged, "a message changes under a lease");
  machine->check(was_mine || self.reading.hold == Hold::doubted_lease,
                 "a living reader's lease was taken away");
  for (int i = 1; i < self.held; ++i)
    self.leases[i - 1] = self.leases[i], self.payloads[i - 1] = self.payloads[i];
  --self.held;
  self.leases[self.held] = {};
  self.payloads[self.held] = 0;
  return was_mine;
}

ReaderLocals::Phase after_taking(ReaderLocals& self, const Got& got) {
  const bool sleeps = self.reading.waits && got.outcome == Outcome::nothing;
  if (!sleeps) --self.left;
  if (self.held == self.reading.leases_at_once || (self.held > 0 && (self.left == 0 || sleeps)))
    return ReaderLocals::releasing;
  if (sleeps) return ReaderLocals::sleeping;
  return self.left > 0 ? ReaderLocals::taking : ReaderLocals::leaving;
}

ReaderLocals::Phase after_releasing(const ReaderLocals& self) {
  if (self.left > 0) return ReaderLocals::taking;
  return self.held > 0 ? ReaderLocals::releasing : ReaderLocals::leaving;
}

/// Claims a row, or frees it; returns the new owner word, or 0 if its owner lives or another
/// process was faster.
std::uint64_t claim(int row, bool keeps_it) {
  machine->act_as(Role::recoverer);
  const auto words = ring->words();
  const auto before = ModelAtomics::load(words.owner(row), std::memory_order_acquire);
  const auto pid = ipc::pid_of_owner(before);
  if (pid != 0 && !machine->is_gone(static_cast<int>(pid) - 1)) return 0;
  const auto generation = (ipc::generation_of(before) + 1) & 0xffff;
  const auto after =
      keeps_it ? owner_of(machine->thread(), generation) : ipc::free_word(generation);
  return ipc::claim_row(words, row, before, after) ? after : 0;
}

}  // namespace

bool run_reader(void* locals) {
  auto& self = *static_cast<ReaderLocals*>(locals);
  switch (self.phase) {
    case ReaderLocals::claiming:
      self.owner = claim(self.row, true);
      if (self.owner == 0) return false;
      self.core = {ring->words(), self.row, ipc::generation_of(self.owner)};
      self.phase = ReaderLocals::starting;
      return true;
    case ReaderLocals::starting:
      self.core.start();
      self.phase = ReaderLocals::taking;
      return true;
    case ReaderLocals::taking: {
      const auto seen = self.core.seen();
      const auto got = self.reading.hold == Hold::copy ? take_copy(self) : take_lease(self);
      judge(self, got, seen);
      self.phase = after_taking(self, got);
      return self.phase != ReaderLocals::leaving || !self.reading.stays;
    }
    case ReaderLocals::sleeping:
      self.core.wait(1);
      self.phase = ReaderLocals::taking;
      return true;
    case ReaderLocals::releasing:
      if (!release_oldest(self)) return false;
      self.phase = after_releasing(self);
      return self.phase != ReaderLocals::leaving || !self.reading.stays;
    case ReaderLocals::leaving:
      ipc::release_row(ring->words(), self.row, self.owner);
      return false;
  }
  return false;
}

bool run_recoverer(void* locals) {
  claim(static_cast<RecovererLocals*>(locals)->row, false);
  return false;
}

}  // namespace handcast::explorer
