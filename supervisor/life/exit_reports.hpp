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

/// The end of one process as the keeper sends it: si_pid, si_code and si_status of its siginfo_t.
struct ExitReport {
  pid_t pid = 0;
  int code = 0;
  int status = 0;
};

/// How processes ended that are not children of this supervisor. They are children of its keeper,
/// which inherits the services of a supervisor that died. The keeper takes their exit status and
/// sends each as a datagram over a socket pair.
class ExitReports {
 public:
  /// Takes the socket that kKeeperVariable names, and unsets the variable. Without a keeper nothing
  /// is ever reported.
  static ExitReports from_environment();

  /// Readable when something was reported. Does not block. -1 if there is no keeper.
  int fd() const { return socket_.get(); }
  /// Reads what was reported.
  void read();
  /// The keeper's process number; -1 if it is not the parent of this process.
  pid_t keeper() const;
  /// How a process ended, once; empty if that was not reported.
  std::optional<Exit> take(pid_t pid);

 private:
  UniqueFd socket_;
  std::map<pid_t, Exit> exits_;
};

/// How a process ended that another process has reaped. Empty until then, and before Linux 6.15.
std::optional<Exit> exit_told_by_kernel(int pidfd);

}  // namespace handcast::supervisor
