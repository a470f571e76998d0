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
#include "supervisor/life/exit_reports.hpp"
#include "supervisor/life/saved_service.hpp"

namespace handcast::supervisor {

/// What a daemon is started with (ipc/daemon/contract.hpp).
struct ChildSpec {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  daemon::Rings rings;  ///< the supervisor's descriptors, which the daemon inherits
  std::int64_t epoch_ns = 0;
  bool spare = false;  ///< it prepares everything and waits for its turn
};

/// One process of a daemon, leader of its own session. It goes on if the supervisor dies;
/// destroying the object kills it and waits for its end.
class Child {
 public:
  /// Starts a process. Errors: bad_config (no such program), unavailable (no process or descriptor
  /// left).
  static Result<Child> spawn(const ChildSpec& spec);
  /// A process that an earlier supervisor started. `reports` must outlive the object.
  static Child adopt(AdoptedProcess process, ExitReports& reports);
  Child(Child&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)),
        reaped_(other.reaped_),
        reports_(other.reports_),
        ended_ns_(other.ended_ns_),
        pidfd_(std::move(other.pidfd_)),
        log_(std::move(other.log_)),
        ready_(std::move(other.ready_)),
        turn_(std::move(other.turn_)) {}
  Child& operator=(Child&&) = delete;
  ~Child();

  pid_t pid() const { return pid_; }
  bool is_adopted() const { return reports_ != nullptr; }
  /// Readable when the process has ended.
  int pidfd() const { return pidfd_.get(); }
  /// What the process writes to stdout and stderr. Does not block.
  int log_fd() const { return log_.get(); }
  /// What the process says (read_words() in ipc/daemon/words.hpp). Does not block. -1 for an
  /// adopted process.
  int ready_fd() const { return ready_.get(); }
  /// Does nothing if the process has been reaped.
  void signal(int number);
  /// Gives a spare its turn. A spare without its turn ends when this object, or the supervisor, is
  /// gone.
  void give_turn();

  /// How the process ended; empty while it lives. Kills what is left of its process group first.
  /// The end of an adopted process is known when it was reported, or is unknown after 300 ms.
  std::optional<Exit> try_reap();
  /// Whether the process has ended, reaped or not.
  bool has_ended() const;

 private:
  Child() = default;
  std::optional<Exit> try_reap_adopted();

  pid_t pid_ = -1;
  bool reaped_ = false;
  ExitReports* reports_ = nullptr;  ///< of an adopted process
  std::int64_t ended_ns_ = 0;       ///< of an adopted process: when its end was seen
  UniqueFd pidfd_, log_, ready_, turn_;
};

}  // namespace handcast::supervisor
