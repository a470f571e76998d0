// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace handcast::supervisor {

/// Makes this process the keeper of a supervisor, the program `arguments[0]` with its arguments.
/// The keeper starts the supervisor in a process group of its own and starts it again if it dies by
/// a signal, or if it is a successor that cannot take over now (kExitRetry). It reaps the services
/// of a supervisor that died (PR_SET_CHILD_SUBREAPER), reports their ends (life/exit_reports.hpp),
/// and passes SIGINT, SIGTERM and SIGHUP on. It does nothing else, so that little can break.
/// Returns the supervisor's exit code, or kExitRetry if the supervisor dies too often.
int keep(const std::vector<std::string>& arguments);

/// The variable that is set for a supervisor that follows one that died under the same keeper: what
/// that one was asked to do goes on.
inline constexpr const char* kSuccessorVariable = "HANDCAST_SUCCESSOR";

}  // namespace handcast::supervisor
