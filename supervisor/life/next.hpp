// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "supervisor/life/service_event.hpp"
#include "supervisor/life/service_state.hpp"

namespace handcast::supervisor {

/// What the rig file says about a service's life.
struct Rules {
  std::string_view name;       ///< for sentences: "pose"
  std::int64_t ready_ns = 0;   ///< how long a process may take to be ready, or prepared
  std::int64_t stop_ns = 0;    ///< how long it may take to stop before it is killed
  std::int64_t silent_ns = 0;  ///< how long it may give no sign of life
  bool publishes = false;      ///< it has a stream: ready is one whose first message is there
  bool wants_standby = false;  ///< a spare is kept
};

struct Step {
  ServiceState state;
  std::vector<Action> actions;  ///< in the order in which they are to be carried out
};

/// What becomes of a service when something happens to it, and what is to be done. All that is
/// decided about a service is decided here: a pure function. What follows from a death is
/// Transition::died() in next.cpp, how long a restart waits is decide() in restart_policy.hpp.
Step next(ServiceState state, const Event& event, std::int64_t now_ns, const Rules& rules);

}  // namespace handcast::supervisor
