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
  bool spare = false;      ///< it prepares everything and waits for its turn
  bool log_errors = true;  ///< stderr is read with stdout; otherwise it is this process's own
};

/// One process of a daemon, leader of its own session. It outlives a supervisor that dies;
/// destroying the object kills it and waits for its end.
class Child {
 public:
  /// Errors: bad_config (no such program), unavailable (no process or descriptor to be had).
  static Result<Child> spawn(const ChildSpec& spec);
  /// A process that somebody else started. `reports` must outlive it; how it ended may stay
  /// unknown.
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
  int pidfd() const { return pidfd_.get(); }  ///< readable when the process has ended
  int log_fd() const {
    return log_.get();
  }  ///< what it writes to stdout and stderr; does not block
  int ready_fd() const {
    return ready_.get();
  }  ///< one newline when it is ready ('s' from a spare); does not block; -1 of an adopted one
  void signal(int number);
  /// Lets a spare go to work. Without its turn it ends when this object, or the supervisor, is
  /// gone.
  void give_turn();

  /// Empty while it lives (of an adopted one: also until its end was reported, 300 ms at most). At
  /// its end: kills what is left of its process group, then takes the exit status.
  std::optional<Exit> try_reap();
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

/// The standard output of a short command, which is killed after `limit_ms`. Errors: unavailable.
Result<std::string> output_of(const std::filesystem::path& program,
                              const std::vector<std::string>& arguments, int limit_ms);

}  // namespace handcast::supervisor
