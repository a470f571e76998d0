// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "ipc/base/unique_fd.hpp"
#include "supervisor/base/exit.hpp"

namespace handcast::supervisor {

/// The environment variable with the number of the supervisor's end of the keeper's socket.
inline constexpr const char* kKeeperVariable = "HANDCAST_KEEPER_FD";

/// The end of one process as the keeper sends it: a datagram with members of its siginfo_t.
struct ExitReport {
  pid_t pid = 0;   ///< si_pid
  int code = 0;    ///< si_code: CLD_EXITED, CLD_KILLED or CLD_DUMPED
  int status = 0;  ///< si_status: the exit code, or the number of the signal
};

/// A sign of life that the supervisor sends to its keeper, a datagram on the same socket pair.
struct Beat {
  bool stopping = false;        ///< the rig is being stopped: no successor is wanted
  std::array<char, 108> rig{};  ///< name of the rig, ended by '\0'
};
/// The time between two beats.
inline constexpr std::int64_t kBeatToKeeper_ns = 200'000'000;

/// The supervisor's end of the socket pair to its keeper. It gets the ends of processes that are
/// not children of this supervisor: the services of a supervisor that died become children of its
/// keeper, which reaps them and sends an ExitReport for each. It sends beats.
class KeeperLink {
 public:
  /// Takes the socket that kKeeperVariable names, and unsets the variable. Without a keeper there
  /// are no reports.
  static KeeperLink from_environment();

  /// A descriptor that is readable when a report has arrived. Non-blocking. -1 if there is no
  /// keeper.
  int fd() const { return socket_.get(); }
  /// Reads the reports that have arrived.
  void read();
  /// Sends a beat.
  void beat(std::string_view rig, bool stopping);
  /// True if there was a keeper and it has died.
  bool keeper_died() const { return had_keeper_ && !socket_; }
  /// How a process ended; empty if that was not reported. Removes the report.
  std::optional<Exit> take(pid_t pid);

 private:
  UniqueFd socket_;
  bool had_keeper_ = false;
  std::map<pid_t, Exit> exits_;
};

/// How a process ended that another process has reaped. Empty until it is reaped, and always before
/// Linux 6.15.
std::optional<Exit> exit_told_by_kernel(int pidfd);

}  // namespace handcast::supervisor
