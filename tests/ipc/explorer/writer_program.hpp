// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/ipc/explorer/ring_memory.hpp"

namespace handcast::explorer {

/// The locals of a writer. It attaches, then repeatedly loans, fills and publishes a slot.
struct WriterLocals {
  /// The next operation.
  enum Phase : std::uint8_t { attaching, loaning, publishing };

  /// A writer that has not attached yet.
  explicit WriterLocals(const Words& words) : core(words) {}

  ipc::WriterCore<ModelAtomics, kModelSlots> core;  ///< the protocol
  Phase phase = attaching;                          ///< the next operation
  std::uint8_t left = 0;                            ///< number of messages left
  std::uint8_t abandons = 0;        ///< number of the next messages that are abandoned instead
  bool never_drops = false;         ///< there are enough slots: a loan must not fail
  std::int8_t slot = ipc::kNoSlot;  ///< the loaned slot
};

/// The operations of a writer; `locals` is a WriterLocals. See Program::operation.
bool run_writer(void* locals);

}  // namespace handcast::explorer
