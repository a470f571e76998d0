// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/safe_state.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <cstring>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/base/spawn.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::chrono::seconds kPatience{3};
constexpr double kLook_s = 0.2;

bool has_ended_by_itself(const Service& service) {
  const auto& last = service.last_exit();
  return last && last->is_success();
}

}  // namespace

void leave_safe(const Service& service, const Launch& launch, const std::function<void()>& beat) {
  const auto& spec = service.spec();
  if (!spec.has_safe_state || has_ended_by_itself(service)) return;
  auto command = command_of(spec, launch.program_folder);
  command.insert(command.end(),
                 {"--safe", "--config", fmt::format("/proc/self/fd/{}", launch.rig_fd)});
  SpawnFiles files;
  files.inherit(launch.rig_fd);
  const auto pid = spawn(command, files);
  const auto& program = command.front();
  if (!pid)
    return log::error("{} --safe cannot be started: {}", program, std::strerror(pid.error()));
  const auto process = open_pidfd(*pid);
  for (const auto limit = Deadline::in(kPatience); !ends_within(process, kLook_s);) {
    beat();
    if (!limit.passed()) continue;
    log::error("{} --safe has not ended within {} s; killed", program, kPatience.count());
    send_signal(process, SIGKILL);
    ends_within(process, kLook_s);
    break;
  }
  waitpid(*pid, nullptr, WNOHANG);  // one that hangs in its device is left to the keeper
}

}  // namespace handcast::supervisor
