// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "tests/ipc/explorer/machine.hpp"

namespace handcast::explorer {

struct Found {
  std::string broken;  ///< the property that does not hold; empty where all do in every execution
  bool is_complete = true;  ///< false where `max_states` ended the search
  std::uint64_t states = 0, steps = 0, ends = 0;
  int depth = 0;
  double seconds = 0;
  std::string trace;  ///< a line per step, to the broken property
};

/// Every execution from `start`, depth first. `at_end` looks at states in which nobody runs any
/// more; it gives what is wrong, or null.
Found explore(Machine& machine, const State& start,
              const std::function<const char*(const State&)>& at_end,
              std::uint64_t max_states = 100'000'000);

}  // namespace handcast::explorer
