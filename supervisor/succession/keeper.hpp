// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace handcast::supervisor {

/// The name of the keeper's process (/proc/PID/comm).
inline constexpr const char* kKeeperName = "handcast-keeper";

/// Makes this process the keeper of a supervisor, the program `arguments[0]` with its arguments.
/// The keeper starts the supervisor in its own process group. It reaps the services of a supervisor
/// that died (PR_SET_CHILD_SUBREAPER), reports their ends (life/keeper_link.hpp), and forwards
/// SIGINT, SIGTERM and SIGHUP, unless they were ignored when it started. It kills a supervisor that
/// sends no beat for two seconds, and at once when the same stop signal comes for the third time.
/// It starts a successor if the supervisor is killed by a signal, or if a successor exits with
/// kExitRetry; but if the rig was to be stopped, it ends the services itself. It does nothing else,
/// so that it rarely fails itself. Returns the supervisor's exit code, kExitRetry if the supervisor
/// dies too often, or kExitBadResult if the keeper had to end the services.
int keep(const std::vector<std::string>& arguments);

/// The environment variable that is set for a successor, which continues the run of the supervisor
/// that died under the same keeper.
inline constexpr const char* kSuccessorVariable = "HANDCAST_SUCCESSOR";

}  // namespace handcast::supervisor
