// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "ipc/daemon/contract.hpp"
#include "supervisor/life/service_event.hpp"
#include "supervisor/life/service_state.hpp"

namespace handcast::supervisor {

/// The settings of the rig file that next() needs about a service.
struct Rules {
  std::string_view name;       ///< name of the service, for messages: "pose"
  std::int64_t ready_ns = 0;   ///< time limit for a worker to be ready and a spare to be prepared
  std::int64_t stop_ns = 0;    ///< time limit for a process to stop; then it is killed
  std::int64_t silent_ns = 0;  ///< longest time without a heartbeat: see the watchdog below
  bool publishes = false;      ///< it has a stream: it is not ready before its first message
  bool wants_standby = false;  ///< a spare is kept
};

// The watchdog: a worker that has been silent for silent_ns is killed whatever it does, because it
// may be in an endless loop. A quarter of this time is enough if all its threads are stopped, half
// of it if all of them sleep without ever asking for a processor. One that works, or waits for a
// processor on a loaded machine, is given the whole time.

/// The parts of silent_ns, and the least of them: three times the longest pause between heartbeats.
/// @{
inline constexpr double kStoppedPart = 0.25, kAsleepPart = 0.5;
inline constexpr std::int64_t kLeastSilence_ns = 3 * daemon::kBeatEvery_ns;
/// @}
/// It must have been stopped or asleep for this part of the permitted silence.
inline constexpr double kInertPart = 0.3;

/// True if the worker has been silent for so long that the next Tick needs its activity.
/// `last_sign_ns`: see event::Tick.
bool is_suspicious(const ServiceState& state, std::optional<std::int64_t> last_sign_ns,
                   std::int64_t now_ns, const Rules& rules);

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
