// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace handcast::supervisor {

/// Becomes the keeper of a supervisor: starts `arguments` (the path of a program, this one again,
/// and what it gets) in a process group of its own, starts it again when it dies by a signal (or, a
/// successor, cannot take over now: kExitRetry), inherits and reaps the services it leaves behind
/// (PR_SET_CHILD_SUBREAPER), hands SIGINT, SIGTERM and SIGHUP on. Does nothing else: what does
/// nothing does not break. The supervisor's exit code, or kExitRetry where it dies too often.
int keep(const std::vector<std::string>& arguments);

/// Set for a supervisor that follows one that died under the same keeper: what that one was asked
/// to do goes on.
inline constexpr const char* kSuccessorVariable = "HANDCAST_SUCCESSOR";

}  // namespace handcast::supervisor
