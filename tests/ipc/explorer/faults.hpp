// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "tests/ipc/explorer/memory_model.hpp"

/// Faults that are planted under the protocol: its code is unchanged, but its operations behave
/// differently.
namespace handcast::explorer {

/// A kind of operation on shared memory.
enum class Operation : std::uint8_t { load, store, exchange, fence, wake };
/// A kind of shared word (ipc/ring/words.hpp).
enum class Kind : std::uint8_t { head, epoch, state, owner, wait, lease, payload, other };
/// The side of the protocol that a thread plays.
enum class Role : std::uint8_t { writer, reader, recoverer };

/// An operation on a kind of word.
struct Place {
  Operation operation;  ///< what is done
  Kind kind;            ///< the word it is done to
  /// Equal if both members are.
  bool operator==(const Place&) const = default;
};

/// A fault: the operations that it changes, and how.
struct Fault {
  /// Which operations are changed.
  /// @{
  Role role;
  Operation operation;
  Kind kind;  // for a fence: the word of the operation before it
  /// @}
  /// Only directly after this operation of the same thread. Fences do not count.
  std::optional<Place> after;
  /// Only if it returns true for the value to be stored.
  bool (*when)(std::uint64_t value) = nullptr;

  /// How they are changed: one of the following.
  /// @{
  std::optional<std::memory_order> order;  // uses this memory order
  bool dropped = false;                    // does nothing
  bool plain_store = false;                // for an exchange: stores without a comparison
  std::uint64_t (*instead)(std::uint64_t newest,
                           std::uint64_t value) = nullptr;  // loads or stores another value
  std::vector<Place> overtaken_by;  // for a store: takes effect after these operations
  /// @}
};

/// All faults that are planted at once.
using Faults = std::vector<Fault>;

}  // namespace handcast::explorer
