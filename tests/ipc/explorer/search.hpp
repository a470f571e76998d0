// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "tests/ipc/explorer/machine.hpp"

namespace handcast::explorer {

/// The result of a search.
struct Found {
  std::string broken;       ///< the broken property; empty if all hold in every execution
  bool is_complete = true;  ///< false if `max_states` ended the search
  /// Number of different states, of steps, and of ends of executions.
  /// @{
  std::uint64_t states = 0, steps = 0, ends = 0;
  /// @}
  int depth = 0;       ///< length of the longest execution
  double seconds = 0;  ///< duration of the search
  std::string trace;   ///< the steps to the broken property, one per line
};

/// Explores all executions from `start`, depth first. `at_end` is called with each state in which
/// no thread runs; it returns the broken property, or null.
Found explore(Machine& machine, const State& start,
              const std::function<const char*(const State&)>& at_end,
              std::uint64_t max_states = 100'000'000);

}  // namespace handcast::explorer
