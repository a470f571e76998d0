// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <optional>
#include <string>
#include <utility>

#include "config/sections/external.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "services/guest/output_lines.hpp"

namespace handcast::guest {

/// A program of somebody else as a child of this process: it has its cores and its rig, but neither
/// its real-time priority nor its descriptors, and it does not outlive it. What it starts ends with
/// it, unless this process is killed. One thread.
class GuestProgram {
 public:
  /// Starts `command` in `folder`. What it prints becomes lines of the log. Errors: unavailable
  /// (the sentence says why it cannot be started).
  static Result<GuestProgram> start(const config::External& settings);
  /// `other` has no process afterwards.
  GuestProgram(GuestProgram&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)),
        output_(std::move(other.output_)),
        lines_(std::move(other.lines_)) {}
  GuestProgram& operator=(GuestProgram&&) = delete;
  /// Kills it.
  ~GuestProgram();

  /// Passes on what it prints until the deadline. Takes at most 12 MB a second: a program that
  /// prints more waits.
  void pass_on_output(Deadline deadline);
  /// How it ended and its last line: "exit 1: No module named 'torch'"; empty while it runs.
  std::optional<std::string> end();
  /// The last line that it has printed, for people; "" if there is none.
  std::string last_line() const;
  /// Asks it to end (SIGTERM), and kills it at the deadline.
  void stop(Deadline deadline);

 private:
  GuestProgram(pid_t pid, UniqueFd output);
  bool read_some();

  pid_t pid_;
  UniqueFd output_;
  OutputLines lines_;
};

/// Whether the program of a command, and the folder for it, are there. Errors: bad_config.
Result<void> check_command(const config::External& settings);

}  // namespace handcast::guest
