// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/daemon/handover.hpp"
#include "supervisor/base/exit.hpp"
#include "supervisor/life/keeper_link.hpp"
#include "supervisor/life/saved_service.hpp"

namespace handcast::supervisor {

/// The program and the environment of a daemon (ipc/daemon/contract.hpp).
struct ChildSpec {
  std::filesystem::path program;       ///< path of the executable
  std::vector<std::string> arguments;  ///< without argv[0]
  daemon::Rings rings;                 ///< the supervisor's descriptors; the daemon inherits them
  std::int64_t epoch_ns = 0;           ///< HANDCAST_EPOCH_NS
  std::string rig;                     ///< HANDCAST_RIG
  int state_fd = -1;                   ///< HANDCAST_STATE_FD; -1: none
  int rig_fd = -1;                     ///< the applied rig file, which `arguments` name; -1: none
  bool standby = false;                ///< the daemon prepares itself and waits for its turn
  std::vector<int> kept_open{};        ///< further descriptors that it inherits
};

/// One process of a daemon, the leader of its own session. It continues to run if the supervisor
/// dies. Destroying the object kills it and waits for its end.
class Child {
 public:
  /// Starts a process. Errors: bad_config (no such program), unavailable (no more processes or
  /// descriptors).
  static Result<Child> spawn(const ChildSpec& spec);
  /// Takes over a process that an earlier supervisor started. `keeper` must outlive the object.
  static Child adopt(AdoptedProcess process, KeeperLink& keeper);
  /// `other` has no process afterwards.
  Child(Child&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)),
        reaped_(other.reaped_),
        keeper_(other.keeper_),
        ended_ns_(other.ended_ns_),
        pidfd_(std::move(other.pidfd_)),
        log_(std::move(other.log_)),
        ready_(std::move(other.ready_)),
        turn_(std::move(other.turn_)) {}
  Child& operator=(Child&&) = delete;
  ~Child();

  /// The pid; -1 after a move.
  pid_t pid() const { return pid_; }
  /// True if an earlier supervisor started the process.
  bool is_adopted() const { return keeper_ != nullptr; }
  /// A descriptor that is readable when the process has ended.
  int pidfd() const { return pidfd_.get(); }
  /// The output of the process (stdout and stderr). Non-blocking.
  int log_fd() const { return log_.get(); }
  /// The words of the process (read_words() in ipc/daemon/words.hpp). Non-blocking. -1 for an
  /// adopted process.
  int ready_fd() const { return ready_.get(); }
  /// Sends a signal. Does nothing if the process has been reaped.
  void signal(int number);
  /// Gives a standby its turn. A standby that has not got its turn ends when this object is
  /// destroyed or the supervisor dies.
  void give_turn();

  /// How the process ended; empty while it lives. Kills the rest of its process group first. The
  /// end of an adopted process is returned when the keeper has reported it, or as unknown after
  /// 300 ms.
  std::optional<Exit> try_reap();
  /// True if the process has ended, reaped or not.
  bool has_ended() const;

 private:
  Child() = default;
  std::optional<Exit> try_reap_adopted();

  pid_t pid_ = -1;
  bool reaped_ = false;
  KeeperLink* keeper_ = nullptr;  ///< set for an adopted process
  std::int64_t ended_ns_ = 0;     ///< when the end of an adopted process was noticed
  UniqueFd pidfd_, log_, ready_, turn_;
};

}  // namespace handcast::supervisor
