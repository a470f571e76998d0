// SPDX-License-Identifier: Apache-2.0
#include "tests/ipc/explorer/ring_memory.hpp"

#include <algorithm>
#include <string>

namespace handcast::explorer {
namespace {

std::uint8_t add(std::string name, Kind kind) {
  return static_cast<std::uint8_t>(machine->add_location(std::move(name), kind));
}

}  // namespace

RingMemory::RingMemory(const RingShape& shape) : shape_(shape) {
  auto words = this->words();
  words.head().location = add("head", Kind::head);
  words.epoch().location = add("epoch", Kind::epoch);
  for (int slot = 0; slot < shape.slots; ++slot)
    words.state(slot).location = add("state" + std::to_string(slot), Kind::state);
  for (int row = 0; row < kModelRows; ++row) {
    const auto of_row = std::to_string(row);
    words.owner(row).location = add("owner" + of_row, Kind::owner);
    words.wait(row).location = add("wait" + of_row, Kind::wait);
    for (int index = 0; index < ipc::kLeasesPerRow; ++index)
      words.lease(row, index).location =
          add("lease" + of_row + "." + std::to_string(index), Kind::lease);
  }
  for (int slot = 0; slot < shape.slots; ++slot)
    for (int word = 0; word < shape.payload_words; ++word)
      payload_[slot][word] =
          add("payload" + std::to_string(slot) + "." + std::to_string(word), Kind::payload);
  std::fill_n(&read_counts_[0][0], kModelSlots * kMaxThreads, -1);
}

void RingMemory::count_reads_of(int thread) {
  for (int slot = 0; slot < shape_.slots; ++slot) {
    read_counts_[slot][thread] = machine->add_read_count("reads of slot " + std::to_string(slot) +
                                                         " by " + std::to_string(thread));
    counted_[slot].push_back(read_counts_[slot][thread]);
  }
}

Set RingMemory::words_of_writer() const {
  auto words = const_cast<RingMemory*>(this)->words();
  Set set = bit(words.head().location) | bit(words.epoch().location);
  for (int slot = 0; slot < shape_.slots; ++slot) {
    set |= bit(words.state(slot).location);
    for (int word = 0; word < shape_.payload_words; ++word) set |= bit(payload_[slot][word]);
  }
  return set;
}

Set RingMemory::lease_words(int row) const {
  auto words = const_cast<RingMemory*>(this)->words();
  Set set = 0;
  for (int index = 0; index < ipc::kLeasesPerRow; ++index)
    set |= bit(words.lease(row, index).location);
  return set;
}

Set RingMemory::words_of_row(int row) const {
  auto words = const_cast<RingMemory*>(this)->words();
  return lease_words(row) | bit(words.owner(row).location) | bit(words.wait(row).location);
}

}  // namespace handcast::explorer
