// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "supervisor/life/service_event.hpp"
#include "supervisor/life/service_state.hpp"

namespace handcast::supervisor {

/// The settings of the rig file that next() needs about a service.
struct Rules {
  std::string_view name;       ///< name of the service, for messages: "pose"
  std::int64_t ready_ns = 0;   ///< time limit for a worker to be ready and a spare to be prepared
  std::int64_t stop_ns = 0;    ///< time limit for a process to stop; then it is killed
  std::int64_t silent_ns = 0;  ///< longest time without a heartbeat
  bool publishes = false;      ///< it has a stream: it is not ready before its first message
  bool wants_standby = false;  ///< a spare is kept
};

/// The result of next().
struct Step {
  ServiceState state;           ///< the new state
  std::vector<Action> actions;  ///< to be carried out in this order
};

/// The state of a service after an event, and the actions that follow. A pure function that makes
/// all decisions about a service. Transition::died() in next.cpp handles deaths; decide() in
/// restart_policy.hpp determines the waiting time before a restart.
Step next(ServiceState state, const Event& event, std::int64_t now_ns, const Rules& rules);

}  // namespace handcast::supervisor
