// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tests/ipc/explorer/ring_memory.hpp"

namespace handcast::explorer {

/// The function of ReaderCore that a reader uses.
enum class Verb : std::uint8_t { latest, next, nearest };
/// How a reader holds a message.
enum class Hold : std::uint8_t {
  copy,   ///< as a copy
  lease,  ///< by a lease
  /// By a lease of a living process that was mistaken for dead. It reads atomically, and uses the
  /// data only after release() has succeeded.
  doubted_lease,
};

/// The behaviour of a reader.
struct Reading {
  Verb verb = Verb::latest;  ///< how it looks for messages
  Hold hold = Hold::copy;    ///< how it holds them
  int takes = 1;             ///< number of attempts to take a message
  bool waits = false;        ///< sleeps if there is no message; such attempts do not count
  int leases_at_once = 1;    ///< number of messages it holds before it releases the oldest
  bool stays = false;        ///< ends without releasing its row, like a reader that continues
};

/// The locals of a reader. It owns its row from the beginning, or claims it first: a free one, or
/// that of a dead process.
struct ReaderLocals {
  /// The next operation.
  enum Phase : std::uint8_t { claiming, starting, taking, sleeping, releasing, leaving };

  /// A reader that owns its row already.
  ReaderLocals(const Words& words, int which_row, std::uint64_t generation)
      : core(words, which_row, generation), row(which_row) {}

  ipc::ReaderCore<ModelAtomics> core;            ///< the protocol
  ipc::Lease leases[ipc::kLeasesPerRow];         ///< the leases that it holds, oldest first
  std::uint64_t payloads[ipc::kLeasesPerRow]{};  ///< the payloads of their messages
  std::uint64_t owner = 0;                       ///< its owner word
  int row;                                       ///< number of its row
  Phase phase = taking;                          ///< the next operation
  std::uint8_t held = 0;                         ///< number of leases that it holds
  std::uint8_t left = 0;                         ///< number of attempts left
  Reading reading;                               ///< its behaviour
};

/// The operations of a reader; `locals` is a ReaderLocals. See Program::operation.
bool run_reader(void* locals);

/// The locals of a recoverer, which frees the row of a dead reader.
struct RecovererLocals {
  int row;  ///< number of the row
};
/// The operation of a recoverer; `locals` is a RecovererLocals. See Program::operation.
bool run_recoverer(void* locals);

/// The owner word of a thread of the machine.
inline std::uint64_t owner_of(int thread, std::uint64_t generation) {
  return ipc::owner_word(generation, 0, static_cast<std::uint64_t>(thread) + 1);
}

}  // namespace handcast::explorer
