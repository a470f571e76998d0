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

/// Whether it is a process that a supervisor started: a leader of its own session that runs one of
/// our daemons, replaced by now or not.
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

// Daemons among the keeper's children are what earlier supervisors have left. Who became a keeper
// by exec has other children, too.
void end_strays(const ExitReports& reports, const std::optional<AdoptedRig>& adopted,
                const std::filesystem::path& program_folder) {
  const auto keeper = reports.keeper();
  if (keeper < 0) return;
  const auto children = children_of(keeper);
  if (reports.keeper() != keeper) return;  // it died, and these may be anybody's
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
        saved.state == State::starting || saved.state == State::stopping;  // it is begun anew
    if (auto* service = rig.services.find(saved.name); service && !was_between)
      service->inherit(saved);
  }
  for (auto& process : adopted.services) {
    const auto name = process.saved.name;
    log::info("{} (pid {}) lives and is taken over", name, process.saved.pid);
    auto* service = rig.services.find(name);
    if (!service) service = &rig.services.add({.name = name});
    service->adopt(std::move(process));
  }
}

}  // namespace handcast::supervisor
