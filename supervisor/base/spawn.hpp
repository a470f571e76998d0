// SPDX-License-Identifier: Apache-2.0
// Programs that are started with posix_spawn(3), which copies no memory.
#pragma once
#include <spawn.h>
#include <sys/types.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace handcast::supervisor {

/// The descriptors with which a program starts. It has the three standard ones of this process
/// where nothing else is said; exec closes all others, which have FD_CLOEXEC.
class SpawnFiles {
 public:
  SpawnFiles() { posix_spawn_file_actions_init(&actions_); }
  ~SpawnFiles() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnFiles(const SpawnFiles&) = delete;
  SpawnFiles& operator=(const SpawnFiles&) = delete;

  /// Gives the program the descriptor `own` of this process as its descriptor `its`.
  void give(int own, int its) { posix_spawn_file_actions_adddup2(&actions_, own, its); }
  /// Gives it a descriptor under the same number: dup2() of a descriptor onto itself clears
  /// FD_CLOEXEC here.
  void inherit(int fd) { give(fd, fd); }
  /// Gives it /dev/null as standard input.
  void close_input();

  /// For posix_spawn().
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// The texts as exec takes them, ended by a null pointer. They point into `texts`.
std::vector<char*> pointers_to(std::vector<std::string>& texts);

/// Starts a program, of which command[0] is the path, with the environment of this process. Returns
/// its pid, or the error number.
tl::expected<pid_t, int> spawn(std::vector<std::string> command, const SpawnFiles& files);

}  // namespace handcast::supervisor
