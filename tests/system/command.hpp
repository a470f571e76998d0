// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace handcast::system_test {

using Arguments = std::vector<std::string>;

/// A process of a `handcast` command. Its output goes to files. The destructor kills it, but not
/// the supervisor and the services of a rig: see kill_all_of().
class Command {
 public:
  /// `folder`: for the output files; also the command's HANDCAST_SCOPE, so that it does not see
  /// rigs of other tests.
  Command(const std::filesystem::path& folder, const Arguments& arguments);
  ~Command();
  Command(const Command&) = delete;

  /// The pid; for `handcast up`, that of the keeper.
  pid_t pid() const { return pid_; }
  /// The pid of the supervisor of `handcast up`; -1 if there is none.
  pid_t supervisor() const;
  void signal(int number) const;
  bool running();
  int wait();                  ///< the exit code, or 128 + the number of the signal
  std::string output() const;  ///< stdout
  std::string log() const;     ///< stderr

 private:
  std::filesystem::path output_, log_;
  pid_t pid_ = -1;
  int exit_code_ = -1;
  bool reaped_ = false;
};

/// Waits until `done` returns true. Returns false after a minute.
bool eventually(const std::function<bool()>& done);

/// True if the process exists and is not a zombie.
bool is_alive(pid_t pid);

/// The processes that were started with this scope (HANDCAST_SCOPE).
std::vector<pid_t> processes_of(const std::filesystem::path& scope);
/// Kills all of them.
void kill_all_of(const std::filesystem::path& scope);

/// The folder of handcast and its daemons.
std::filesystem::path program_folder();
/// Why the tests cannot run; "" if all programs have been built.
std::string missing_program();

}  // namespace handcast::system_test
