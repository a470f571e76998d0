// SPDX-License-Identifier: Apache-2.0
#include "tests/ipc/explorer/machine.hpp"

namespace handcast::explorer {
namespace {

unsigned long long shown(std::uint64_t value) { return value; }

}  // namespace

int Machine::add_location(std::string name, Kind kind) {
  names_.push_back(std::move(name));
  kinds_.push_back(kind);
  return locations() - 1;
}

void Machine::close() {
  for (int i = 0; i < threads(); ++i) {
    Set family = bit(i);  // the thread and all that it starts, directly or not
    for (int round = 0; round < threads(); ++round)
      for (int k = 0; k < threads(); ++k)
        if (family & bit(k)) family |= program(k).starts_on_death | program(k).starts_on_end;
    reads_[i] = writes_[i] = 0;
    for (int k = 0; k < threads(); ++k)
      if (family & bit(k)) reads_[i] |= program(k).reads, writes_[i] |= program(k).writes;
  }
}

bool Machine::only_i_write(int location) {
  if (every_order_) return false;
  for (int i = 0; i < threads(); ++i)
    if (i != thread() && state().threads[i].lives() && writes_[i] & bit(location)) return false;
  return true;
}

Manner Machine::manner_of_load(int location) {
  if (replaying() || !only_i_write(location)) return Manner::contested;
  return knows_newest(location) ? Manner::unnoticed : Manner::early_choice;
}

Manner Machine::manner_of_store(int location) {
  return !replaying() && only_i_write(location) && knows_newest(location) ? Manner::early
                                                                          : Manner::contested;
}

std::uint64_t Machine::load(int location, std::memory_order order) {
  release_held_back(Operation::load, kind(location));
  const auto* fault = meet(Operation::load, kind(location));
  if (fault && fault->order) order = *fault->order;
  touch(Operation::load, kind(location));
  const auto manner = manner_of_load(location);
  const auto value = perform(manner, [&](Thread& self) {
    const int newest = state().memory.newest(location), oldest = self.views.current.place[location];
    const int place = manner == Manner::unnoticed ? newest : newest - choose(newest - oldest + 1);
    const auto read_value = read(state().memory, self.views, location, place, acquires(order));
    say("load %s: %llx%s", name(location).c_str(), shown(read_value),
        place < newest ? " (not the newest)" : "");
    return read_value;
  });
  return fault && fault->instead ? fault->instead(state().memory.newest_value(location), value)
                                 : value;
}

void Machine::append(Thread& self, int location, std::uint64_t value, bool release,
                     const Message* replaced) {
  if (state().memory.length[location] == kMaxMessages)
    std::fputs("explorer: kMaxMessages is too small\n", stderr), std::abort();
  explorer::append(changing().memory, self.views, location, value, release, replaced);
  if (watcher_ && kind(location) == watched_) watcher_(*this, changing(), location, value);
}

void Machine::store(int location, std::uint64_t value, std::memory_order order) {
  release_held_back(Operation::store, kind(location));
  const auto* fault = meet(Operation::store, kind(location), value);
  touch(Operation::store, kind(location));
  if (!fault) return store_now(location, value, order);
  if (fault->dropped) return;
  if (!fault->overtaken_by.empty()) {
    held_back_ = {fault, location, value, order};
    return;
  }
  if (fault->instead) value = fault->instead(state().memory.newest_value(location), value);
  store_now(location, value, fault->order.value_or(order));
}

void Machine::store_now(int location, std::uint64_t value, std::memory_order order) {
  perform(manner_of_store(location), [&](Thread& self) {
    append(self, location, value, releases(order), nullptr);
    say("store %s = %llx", name(location).c_str(), shown(value));
    return std::uint64_t{0};
  });
}

bool Machine::exchange(int location, std::uint64_t expected, std::uint64_t desired,
                       std::memory_order order) {
  release_held_back(Operation::exchange, kind(location));
  const auto* fault = meet(Operation::exchange, kind(location), desired);
  touch(Operation::exchange, kind(location));
  if (!fault) return exchange_now(location, expected, desired, order);
  if (fault->plain_store) store_now(location, desired, fault->order.value_or(order));
  if (fault->plain_store || fault->dropped) return true;
  return exchange_now(location, expected, desired, fault->order.value_or(order));
}

/// Succeeds only on the newest message. Fails on that, or like a load on an older message with
/// another value.
bool Machine::exchange_now(int location, std::uint64_t expected, std::uint64_t desired,
                           std::memory_order order) {
  return perform(manner_of_store(location), [&](Thread& self) {
           const auto& memory = state().memory;
           int places[kMaxMessages], count = 0;
           const int newest = places[count++] = memory.newest(location);
           for (int place = newest - 1; place >= self.views.current.place[location]; --place)
             if (memory.history[location][place].value != expected) places[count++] = place;
           const int place = places[count == 1 ? 0 : choose(count)];
           const auto before = memory.history[location][place];
           const bool done = place == newest && before.value == expected;
           read(memory, self.views, location, place, done && acquires(order));
           if (done) append(self, location, desired, releases(order), &before);
           say("exchange %s: %llx -> %llx %s", name(location).c_str(), shown(expected),
               shown(desired), done ? "done" : "fails");
           return std::uint64_t{done};
         }) != 0;
}

void Machine::fence(std::memory_order order) {
  const auto* fault = meet(Operation::fence, touched_.kind);
  if (fault && fault->dropped) return;
  if (fault && fault->order) order = *fault->order;
  const bool is_global = order == std::memory_order_seq_cst;
  perform(is_global ? Manner::contested : Manner::unnoticed, [&](Thread& self) {
    is_global ? seq_cst_fence(changing().memory, self.views) : local_fence(self.views, order);
    say(is_global ? "fence seq_cst" : "fence");
    return std::uint64_t{0};
  });
}

void Machine::futex_wait(int location, std::uint64_t seen) {
  perform(Manner::contested, [&](Thread& self) {
    seq_cst_fence(changing().memory, self.views);
    const int newest = state().memory.newest(location);
    const int place = newest - choose(newest - self.views.current.place[location] + 1);
    const auto value = read(state().memory, self.views, location, place, false);
    const bool sleeps = static_cast<std::uint32_t>(value) == static_cast<std::uint32_t>(seen);
    if (sleeps)
      self.status = Status::sleeping, self.sleeps_on = static_cast<std::uint8_t>(location);
    say(sleeps ? "futex: sleeps" : "futex: does not sleep");
    return std::uint64_t{0};
  });
}

void Machine::futex_wake(int location) {
  release_held_back(Operation::wake, kind(location));
  const auto* fault = meet(Operation::wake, kind(location));
  if (fault && fault->dropped) return;
  perform(Manner::contested, [&](Thread& self) {
    seq_cst_fence(changing().memory, self.views);
    for (auto& sleeper : changing().threads)
      if (sleeper.status == Status::sleeping && sleeper.sleeps_on == location)
        sleeper.status = Status::running, sleeper.sleeps_on = 0;
    say("futex: wakes all");
    return std::uint64_t{0};
  });
}

/// No other order needs to be tried: a write that is not ordered with this read is detected here if
/// it came before, and in write_payload() if it comes later.
std::uint64_t Machine::plain_read(int location, int read_count) {
  return perform(Manner::unnoticed, [&](Thread& self) {
    check(knows_newest(location), "a payload is written while a lease reads it");
    auto& memory = changing().memory;
    const int count = memory.length[read_count]++;
    if (count == kMaxMessages)
      std::fputs("explorer: kMaxMessages is too small\n", stderr), std::abort();
    memory.history[read_count][count] = {};
    self.views.current.raise(read_count, count);
    self.views.acquirable.raise(read_count, count);
    say("plain read of %s", name(location).c_str());
    return memory.newest_value(location);
  });
}

void Machine::write_payload(int location, std::uint64_t value,
                            const std::vector<int>& read_counts) {
  release_held_back(Operation::store, Kind::payload);
  const auto* fault = meet(Operation::store, Kind::payload, value);
  touch(Operation::store, Kind::payload);
  if (fault) {
    held_back_ = {fault, location, value, std::memory_order_relaxed};
    return;
  }
  perform(manner_of_store(location), [&](Thread& self) {
    for (const int reads : read_counts)
      check(knows_newest(reads), "a payload is written while a lease reads it");
    append(self, location, value, false, nullptr);
    say("write %s = %llx", name(location).c_str(), shown(value));
    return std::uint64_t{0};
  });
}

bool Machine::is_gone(int thread) {
  return perform(Manner::contested, [&](Thread& self) {
           const auto& other = state().threads[thread];
           const bool gone = other.status == Status::dead || program(thread).is_doubted;
           if (gone)
             self.views.current.join(other.views.current),
                 self.views.acquirable.join(other.views.current);
           say(gone ? "sees that it is gone" : "sees that it lives");
           return std::uint64_t{gone};
         }) != 0;
}

const Fault* Machine::meet(Operation operation, Kind kind, std::uint64_t value) {
  for (const auto& fault : faults_)
    if (fault.role == role() && fault.operation == operation && fault.kind == kind &&
        (!fault.after || *fault.after == touched_) && (!fault.when || fault.when(value)))
      return &fault;
  return nullptr;
}

void Machine::release_held_back(Operation operation, Kind kind) {
  if (!held_back_.why) return;
  for (const auto& place : held_back_.why->overtaken_by)
    if (place.operation == operation && place.kind == kind) return;
  const auto held = std::exchange(held_back_, {});
  store_now(held.location, held.value, held.order);
}

void Machine::operation_begins() {
  held_back_ = {};
  touched_ = kNothing;
}

void Machine::operation_ends() {
  if (!held_back_.why) return;
  const auto held = std::exchange(held_back_, {});
  store_now(held.location, held.value, held.order);
}

}  // namespace handcast::explorer
