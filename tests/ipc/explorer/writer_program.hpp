// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/ipc/explorer/ring_memory.hpp"

namespace handcast::explorer {

/// A writer: attaches, then loans, fills and publishes again and again.
struct WriterLocals {
  enum Phase : std::uint8_t { attaching, loaning, publishing };

  explicit WriterLocals(const Words& words) : core(words) {}

  ipc::WriterCore<ModelAtomics, kModelSlots> core;
  Phase phase = attaching;
  std::uint8_t left = 0;      ///< messages to publish
  std::uint8_t abandons = 0;  ///< so many of them, the first, are given back instead
  bool never_drops = false;   ///< there are slots enough: a loan never fails
  std::int8_t slot = ipc::kNoSlot;
};

bool run_writer(void* locals);

}  // namespace handcast::explorer
