// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/takeover.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "ipc/base/log.hpp"

namespace handcast::supervisor {
namespace {

std::vector<pid_t> children_of(pid_t parent) {
  std::ifstream file(fmt::format("/proc/{}/task/{}/children", parent, parent));
  std::vector<pid_t> children;
  for (pid_t child = 0; file >> child;) children.push_back(child);
  return children;
}

/// True if the process was started by a supervisor: it leads its own session and runs a program of
/// this name, even if the file has been replaced since.
bool is_a_daemon(pid_t pid, const std::filesystem::path& program_folder) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink(fmt::format("/proc/{}/exe", pid), error);
  return !error && getsid(pid) == pid &&
         program.string().starts_with((program_folder / "handcast-").string());
}

bool lives(const AdoptedRig& adopted, pid_t pid) {
  return std::ranges::any_of(
      adopted.services, [&](const AdoptedProcess& process) { return process.saved.pid == pid; });
}

void report_deaths(const AdoptedRig& adopted, ExitReports& reports) {
  for (const auto& saved : adopted.saved.services) {
    if (saved.pid == 0 || saved.state != State::ready || lives(adopted, saved.pid)) continue;
    const auto exit = reports.take(saved.pid).value_or(Exit{.unknown = true});
    log::warning("{} (pid {}) died while there was no supervisor ({})", saved.name, saved.pid,
                 exit.describe());
  }
}

}  // namespace

// Daemons among the keeper's children were left by earlier supervisors. A keeper that was started
// by exec may have other children, too.
void end_strays(const ExitReports& reports, const std::optional<AdoptedRig>& adopted,
                const std::filesystem::path& program_folder) {
  const auto keeper = reports.keeper();
  if (keeper < 0) return;
  const auto children = children_of(keeper);
  if (reports.keeper() != keeper) return;  // it died; its pid may have been reused
  for (const auto pid : children) {
    if (!is_a_daemon(pid, program_folder) || (adopted && lives(*adopted, pid))) continue;
    ::kill(-pid, SIGKILL);
    ::kill(pid, SIGKILL);
  }
}

Result<void> take_rings(AdoptedRig& adopted, LiveRig& rig, const std::vector<ServiceSpec>& specs) {
  rig.rings.adopt(std::move(adopted.rings));
  const auto wanted = rings_of(specs);
  if (auto fits = rig.rings.check_types(wanted); !fits) return fits;
  return rig.rings.check_sizes(wanted, rig.name);
}

void take_services(AdoptedRig adopted, LiveRig& rig) {
  report_deaths(adopted, *rig.launch.reports);
  for (const auto& saved : adopted.saved.services) {
    const bool was_between =
        saved.state == State::starting || saved.state == State::stopping;  // it is started anew
    if (auto* service = rig.services.find(saved.name); service && !was_between)
      service->inherit(saved);
  }
  for (auto& process : adopted.services) {
    const auto name = process.saved.name;
    log::info("{} (pid {}) is running and is taken over", name, process.saved.pid);
    auto* service = rig.services.find(name);
    if (!service) service = &rig.services.add({.name = name});
    service->adopt(std::move(process));
  }
}

}  // namespace handcast::supervisor
