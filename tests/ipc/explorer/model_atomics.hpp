// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "ipc/ring/protocol.hpp"
#include "tests/ipc/explorer/machine.hpp"

namespace handcast::explorer {

/// The machine whose threads are running. It is global because the operations of the protocol take
/// no other argument.
inline Machine* machine = nullptr;

/// Replaces RealAtomics by the operations of the machine.
struct ModelAtomics {
  /// One word.
  struct Word {
    std::uint8_t location = 0;  ///< its location in the machine
  };

  /// The operations of RealAtomics; wait() has no time limit.
  /// @{
  static std::uint64_t load(const Word& word, std::memory_order order) {
    return machine->load(word.location, order);
  }
  static void store(Word& word, std::uint64_t value, std::memory_order order) {
    machine->store(word.location, value, order);
  }
  static bool compare_exchange(Word& word, std::uint64_t expected, std::uint64_t desired,
                               std::memory_order order) {
    return machine->exchange(word.location, expected, desired, order);
  }
  static void fence(std::memory_order order) { machine->fence(order); }
  static void wait(Word& word, std::uint64_t seen, std::int64_t) {
    machine->futex_wait(word.location, seen);
  }
  static void wake(Word& word) { machine->futex_wake(word.location); }
  /// @}
};

/// The control words of a ring in the machine.
using Words = ipc::ControlWords<ModelAtomics>;

}  // namespace handcast::explorer
