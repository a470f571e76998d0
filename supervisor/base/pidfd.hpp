// SPDX-License-Identifier: Apache-2.0
// Processes by descriptor (pidfd_open(2)): it never refers to another process, even if the pid is
// reused.
#pragma once
#include <sys/types.h>

#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// Opens a process; empty if there is none. The descriptor is readable when the process has ended.
UniqueFd open_pidfd(pid_t pid);
/// Sends a signal. Does nothing if the process has been reaped.
void send_signal(const UniqueFd& pidfd, int number);
/// True if the process has ended, reaped or not.
bool has_ended(const UniqueFd& pidfd);
/// True if the process ends within this time.
bool ends_within(const UniqueFd& pidfd, double seconds);
/// Kills a process and its process group, and waits for its end, at most a second.
void kill_now(pid_t pid, const UniqueFd& pidfd);

}  // namespace handcast::supervisor
