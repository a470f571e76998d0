// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace handcast::system_test {

using Arguments = std::vector<std::string>;

/// A `handcast` command as a process of its own. What it writes goes to files. Killed with the
/// object; a rig's supervisor and services outlive that: kill_all_of().
class Command {
 public:
  /// `folder` gets the output files and is the command's XDG_RUNTIME_DIR: rigs of other folders are
  /// not seen.
  Command(const std::filesystem::path& folder, const Arguments& arguments);
  ~Command();
  Command(const Command&) = delete;

  pid_t pid() const { return pid_; }  ///< of `handcast up`: its keeper
  pid_t supervisor()
      const;  ///< of `handcast up`: the process that the keeper keeps; -1 while there is none
  void signal(int number) const;
  bool running();
  int wait();                  ///< the exit code, or 128 + the signal
  std::string output() const;  ///< stdout
  std::string log() const;     ///< stderr

 private:
  std::filesystem::path output_, log_;
  pid_t pid_ = -1;
  int exit_code_ = -1;
  bool reaped_ = false;
};

/// Tries often until `done` holds; false after a minute.
bool eventually(const std::function<bool()>& done);

/// Whether the process exists and is not only waiting for its exit status to be taken.
bool is_alive(pid_t pid);

/// Kills every process that was started with this runtime folder, however it got away.
void kill_all_of(const std::filesystem::path& folder);

/// Where handcast and its daemons were built.
std::filesystem::path program_folder();
/// Why nothing can be tested here; "" where everything has been built.
std::string missing_program();

}  // namespace handcast::system_test
