// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/ipc/explorer/ring_memory.hpp"

namespace handcast::explorer {

enum class Verb : std::uint8_t { latest, next, nearest };
enum class Hold : std::uint8_t {
  copy,
  lease,
  doubted_lease,  ///< of a process that lives but was taken for dead: it reads atomically, and
                  ///< believes nothing before release() says so
};

/// What a reader does.
struct Reading {
  Verb verb = Verb::latest;
  Hold hold = Hold::copy;
  int takes = 1;           ///< attempts at a message
  bool waits = false;      ///< sleeps where there is nothing, and counts only what it got
  int leases_at_once = 1;  ///< keeps so many messages before it gives the oldest back
  bool stays = false;      ///< ends without giving its row back, as one that is going on does
};

/// One that has the row already, or claims it first: from a dead process, or a free one.
struct ReaderLocals {
  enum Phase : std::uint8_t { claiming, starting, taking, sleeping, releasing, leaving };

  ReaderLocals(const Words& words, int which_row, std::uint64_t generation)
      : core(words, which_row, generation), row(which_row) {}

  ipc::ReaderCore<ModelAtomics> core;
  ipc::Lease leases[ipc::kLeasesPerRow];         ///< those held, the oldest first
  std::uint64_t payloads[ipc::kLeasesPerRow]{};  ///< what they hold
  std::uint64_t owner = 0;
  int row;
  Phase phase = taking;
  std::uint8_t held = 0;
  std::uint8_t left = 0;
  Reading reading;
};

bool run_reader(void* locals);

/// Clears a dead reader's row and leaves it free.
struct RecovererLocals {
  int row;
};
bool run_recoverer(void* locals);

/// The owner word of a thread of the machine.
inline std::uint64_t owner_of(int thread, std::uint64_t generation) {
  return ipc::owner_word(generation, 0, static_cast<std::uint64_t>(thread) + 1);
}

}  // namespace handcast::explorer
