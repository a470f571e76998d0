// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "tests/ipc/explorer/memory_model.hpp"

/// Faults that are planted under the protocol: the code stays as it is, its operations do something
/// else.
namespace handcast::explorer {

enum class Operation : std::uint8_t { load, store, exchange, fence, wake };
enum class Kind : std::uint8_t { head, epoch, state, owner, wait, lease, payload, other };
enum class Role : std::uint8_t { writer, reader, recoverer };

struct Place {
  Operation operation;
  Kind kind;
  bool operator==(const Place&) const = default;
};

struct Fault {
  Role role;
  Operation operation;
  Kind kind;                   ///< of a fence: the kind of word that was touched just before it
  std::optional<Place> after;  ///< only where the thread did this just before; fences do not count
  bool (*when)(std::uint64_t value) = nullptr;  ///< only where this is being stored

  // What happens instead, one of:
  std::optional<std::memory_order> order;  ///< this order
  bool dropped = false;                    ///< nothing
  bool plain_store = false;                ///< an exchange that does not compare
  std::uint64_t (*instead)(std::uint64_t newest,
                           std::uint64_t value) = nullptr;  ///< another value, loaded or stored
  std::vector<Place> overtaken_by;                          ///< a store that these come before
};

using Faults = std::vector<Fault>;

}  // namespace handcast::explorer
