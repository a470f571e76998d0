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
#include "supervisor/exit.hpp"

namespace handcast::supervisor {

/// What a daemon is started with: see the contract in services/runtime/context.hpp.
struct ChildSpec {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::vector<std::pair<std::string, int>> rings;  ///< stream and the supervisor's descriptor of its segment
  std::int64_t epoch_ns = 0;
};

/// One process of a daemon, leader of its own session. Destroying it kills the process and waits for its end.
class Child {
 public:
  /// Errors: bad_config (no such program), unavailable (no process or descriptor to be had).
  static Result<Child> spawn(const ChildSpec& spec);
  Child(Child&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)),
        reaped_(other.reaped_),
        pidfd_(std::move(other.pidfd_)),
        log_(std::move(other.log_)),
        ready_(std::move(other.ready_)) {}
  Child& operator=(Child&&) = delete;
  ~Child();

  pid_t pid() const { return pid_; }
  int pidfd() const { return pidfd_.get(); }     ///< readable when the process has ended
  int log_fd() const { return log_.get(); }      ///< what it writes to stdout and stderr; does not block
  int ready_fd() const { return ready_.get(); }  ///< one newline when it is ready; does not block
  void signal(int number);

  /// Empty while it lives. At its end: kills what is left of its process group, then takes the exit status.
  std::optional<Exit> try_reap();

 private:
  Child() = default;
  pid_t pid_ = -1;
  bool reaped_ = false;
  UniqueFd pidfd_, log_, ready_;
};

/// The standard output of a short command, which is killed after `limit_ms`. Errors: unavailable.
Result<std::string> output_of(const std::filesystem::path& program, const std::vector<std::string>& arguments, int limit_ms);

}  // namespace handcast::supervisor
