// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <map>
#include <optional>

#include "ipc/base/unique_fd.hpp"
#include "supervisor/base/exit.hpp"

namespace handcast::supervisor {

/// The variable that holds the number of the supervisor's end of the keeper's socket.
inline constexpr const char* kKeeperVariable = "HANDCAST_KEEPER_FD";

/// One process's end as the keeper sends it: si_pid, si_code and si_status of its siginfo_t.
struct ExitReport {
  pid_t pid = 0;
  int code = 0;
  int status = 0;
};

/// How processes ended that are not this supervisor's children: its keeper, which inherits the
/// orphans of a supervisor that died, takes their exit status and sends it on (a datagram each,
/// over a socket pair whose end is in HANDCAST_KEEPER_FD).
class ExitReports {
 public:
  static ExitReports from_environment();

  /// -1 where there is no keeper (any more). Readable when something was reported; does not block.
  int fd() const { return socket_.get(); }
  void read();
  /// The keeper's process number, for as long as it is this process's parent; else -1.
  pid_t keeper() const;
  /// Taken once. Empty: not reported (yet).
  std::optional<Exit> take(pid_t pid);

 private:
  UniqueFd socket_;
  std::map<pid_t, Exit> exits_;
};

/// How a process ended that somebody else has reaped, where the kernel tells (from Linux 6.15 on).
/// Empty until it is reaped.
std::optional<Exit> exit_told_by_kernel(int pidfd);

}  // namespace handcast::supervisor
