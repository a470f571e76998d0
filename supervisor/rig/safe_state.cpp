// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/safe_state.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "ipc/base/log.hpp"
#include "supervisor/base/pidfd.hpp"

namespace handcast::supervisor {
namespace {

constexpr double kPatience_s = 3;

bool has_ended_by_itself(const Service& service) {
  const auto& last = service.last_exit();
  return last && last->is_success();
}

/// Starts a program that inherits the rig file. Returns its pid, or -1.
pid_t start(std::string program, std::string rig_file, int rig_fd) {
  std::string safe = "--safe", config = "--config";
  const std::array words{program.data(), safe.data(), config.data(), rig_file.data(),
                         static_cast<char*>(nullptr)};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, rig_fd, rig_fd);  // clears FD_CLOEXEC
  pid_t pid = -1;
  const int error = posix_spawn(&pid, program.c_str(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? pid : -1;
}

}  // namespace

void leave_safe(const Service& service, const Launch& launch) {
  const auto& spec = service.spec();
  if (!spec.has_safe_state || has_ended_by_itself(service)) return;
  const auto program = launch.program_folder / ("handcast-" + spec.name);
  const auto pid =
      start(program.string(), fmt::format("/proc/self/fd/{}", launch.rig_fd), launch.rig_fd);
  if (pid < 0) return log::error("{} --safe cannot be started", program.string());
  const auto process = open_pidfd(pid);
  if (!ends_within(process, kPatience_s)) {
    log::error("{} --safe has not ended within {:g} s; killed", program.string(), kPatience_s);
    send_signal(process, SIGKILL);
  }
  while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace handcast::supervisor
