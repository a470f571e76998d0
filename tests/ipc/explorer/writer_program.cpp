// SPDX-License-Identifier: Apache-2.0
#include "tests/ipc/explorer/writer_program.hpp"

namespace handcast::explorer {
namespace {

void fill(int slot, std::uint64_t payload) {
  for (int word = 0; word < ring->shape().payload_words; ++word)
    machine->write_payload(ring->payload(slot, word), payload, ring->read_counts(slot));
}

/// Loans a slot. Returns false if there is none: the message is dropped.
bool loan(WriterLocals& self) {
  self.slot = static_cast<std::int8_t>(self.core.loan());
  machine->check(self.slot != ipc::kNoSlot || !self.never_drops,
                 "a loan fails although there are enough slots");
  return self.slot != ipc::kNoSlot;
}

void publish(WriterLocals& self) {
  fill(self.slot, payload_of(self.core.next_sequence(), self.core.epoch()));
  if (self.abandons > 0) {
    --self.abandons;
    self.core.abandon(self.slot);
  } else {
    self.core.publish(self.slot);
  }
  self.slot = ipc::kNoSlot;
}

}  // namespace

bool run_writer(void* locals) {
  auto& self = *static_cast<WriterLocals*>(locals);
  switch (self.phase) {
    case WriterLocals::attaching:
      self.core.attach();
      self.phase = WriterLocals::loaning;
      break;
    case WriterLocals::loaning:
      if (loan(self)) {
        self.phase = WriterLocals::publishing;
        return true;
      }
      --self.left;
      break;
    case WriterLocals::publishing:
      publish(self);
      self.phase = WriterLocals::loaning;
      --self.left;
      break;
  }
  return self.left > 0;
}

}  // namespace handcast::explorer
