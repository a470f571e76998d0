// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/takeover.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "ipc/base/log.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/base/pidfd.hpp"

namespace handcast::supervisor {
namespace {

constexpr auto kTakeoverPatience = std::chrono::milliseconds(500);

bool lives(const AdoptedRig& adopted, pid_t pid) {
  return std::ranges::any_of(
      adopted.services, [&](const AdoptedProcess& process) { return process.saved.pid == pid; });
}

void report_deaths(const AdoptedRig& adopted, KeeperLink& keeper) {
  for (const auto& saved : adopted.saved.services) {
    if (saved.pid == 0 || saved.state != State::ready || lives(adopted, saved.pid)) continue;
    const auto exit = keeper.take(saved.pid).value_or(Exit{.unknown = true});
    log::warning("{} (pid {}) died while there was no supervisor ({})", saved.name, saved.pid,
                 exit.describe());
  }
}

}  // namespace

bool end_supervisor_without_keeper(const std::string& name) {
  const auto status = control::ask_with_descriptors(name, {}, kTakeoverPatience);
  if (!status || !status->object["status"].value("keeper_died", false)) return false;
  const auto pid = control::listener_of(*control::address_of(name));
  const auto pidfd = pid > 0 ? open_pidfd(pid) : UniqueFd();
  if (!pidfd) return false;
  log::info("the keeper of rig '{}' has died; its supervisor (pid {}) is replaced", name, pid);
  kill_now(pid, pidfd);
  return true;
}

Result<void> take_rings(AdoptedRig& adopted, LiveRig& rig, const std::vector<ServiceSpec>& specs) {
  rig.rings.adopt(std::move(adopted.rings));
  const auto wanted = rings_of(specs);
  if (auto fits = rig.rings.check_types(wanted); !fits) return fits;
  return rig.rings.check_sizes(wanted, rig.name);
}

void take_services(AdoptedRig adopted, LiveRig& rig) {
  report_deaths(adopted, *rig.launch.keeper);
  for (auto& saved : adopted.saved.services) {
    if (saved.pid != 0 && !lives(adopted, saved.pid)) ++saved.restarts;  // it will be started again
    if (auto* service = rig.services.find(saved.name)) service->inherit(saved);
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
