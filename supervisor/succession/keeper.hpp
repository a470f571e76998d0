// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace handcast::supervisor {

/// Makes this process the keeper of a supervisor, the program `arguments[0]` with its arguments.
/// The keeper starts the supervisor in its own process group. It starts a successor if the
/// supervisor is killed by a signal, or if a successor exits with kExitRetry. It reaps the services
/// of a supervisor that died (PR_SET_CHILD_SUBREAPER), reports their ends (life/exit_reports.hpp),
/// and forwards SIGINT, SIGTERM and SIGHUP. It does nothing else, so that it rarely fails itself.
/// Returns the supervisor's exit code, or kExitRetry if the supervisor dies too often.
int keep(const std::vector<std::string>& arguments);

/// The environment variable that is set for a successor, which continues the run of the supervisor
/// that died under the same keeper.
inline constexpr const char* kSuccessorVariable = "HANDCAST_SUCCESSOR";

}  // namespace handcast::supervisor
