// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/safe_state.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>

#include "ipc/base/log.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/base/spawn.hpp"

namespace handcast::supervisor {
namespace {

constexpr double kPatience_s = 3;

bool has_ended_by_itself(const Service& service) {
  const auto& last = service.last_exit();
  return last && last->is_success();
}

}  // namespace

void leave_safe(const Service& service, const Launch& launch) {
  const auto& spec = service.spec();
  if (!spec.has_safe_state || has_ended_by_itself(service)) return;
  const auto program = launch.program_folder / ("handcast-" + spec.name);
  SpawnFiles files;
  files.inherit(launch.rig_fd);
  const auto pid = spawn(
      {program.string(), "--safe", "--config", fmt::format("/proc/self/fd/{}", launch.rig_fd)},
      files);
  if (!pid)
    return log::error("{} --safe cannot be started: {}", program.string(),
                      std::strerror(pid.error()));
  const auto process = open_pidfd(*pid);
  if (!ends_within(process, kPatience_s)) {
    log::error("{} --safe has not ended within {:g} s; killed", program.string(), kPatience_s);
    send_signal(process, SIGKILL);
  }
  while (waitpid(*pid, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace handcast::supervisor
