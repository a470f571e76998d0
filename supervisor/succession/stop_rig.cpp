// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/stop_rig.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/base/process.hpp"
#include "supervisor/succession/keeper.hpp"
#include "supervisor/succession/process_discovery.hpp"

namespace handcast::supervisor {
namespace {

/// A supervisor that sends nothing for this time, asked twice, is taken to hang.
constexpr auto kPatience = std::chrono::milliseconds(600);
/// The time that a keeper gets to stop a rig whose supervisor hangs.
constexpr double kKeeper_s = 2.5;
/// The time that services get to stop without a supervisor.
constexpr double kServicesEnd_s = 0.5;
/// The time in which systemd starts a supervisor again that was killed.
constexpr double kRevival_s = 1.5;
constexpr int kMostRounds = 3;  ///< of stopping supervisors that come back

/// A process that was opened before it was examined, so that its pid cannot be reused.
struct Process {
  pid_t pid = -1;
  UniqueFd pidfd;
  explicit operator bool() const { return static_cast<bool>(pidfd); }
};

Process open_process(pid_t pid) { return {pid, pid > 1 ? open_pidfd(pid) : UniqueFd()}; }

bool is_keeper(const Process& process) {
  std::ifstream file(fmt::format("/proc/{}/comm", process.pid));
  std::string name;
  return process && std::getline(file, name) && name == kKeeperName;
}

/// The keeper of a process; no process if it has none.
Process keeper_of(pid_t pid) {
  auto parent = open_process(parent_of(pid).value_or(-1));
  return is_keeper(parent) ? std::move(parent) : Process{};
}

/// The keeper of a rig: the parent of its supervisor, or of the services of one that died.
Process keeper_of(const Process& supervisor, const std::string& name) {
  if (supervisor) return keeper_of(supervisor.pid);
  for (const auto& service : find_services(name))
    if (auto keeper = keeper_of(service.pid)) return keeper;
  return {};
}

bool supervisor_comes_back(const std::string& name) {
  for (const auto limit = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(kRevival_s)));
       !limit.passed(); usleep(20'000))
    if (control::has_supervisor(name)) return true;
  return false;
}

/// What end_by_force() did.
struct Forced {
  int ended = 0;            ///< number of processes of services
  bool had_keeper = false;  ///< no successor follows: the keeper is gone, too
};

/// Stops a rig without its supervisor.
Forced end_by_force(const std::string& name, const Process& supervisor, std::int64_t before_ns) {
  const auto keeper = keeper_of(supervisor, name);
  const auto found = static_cast<int>(find_services(name).size());
  if (keeper) {
    send_signal(keeper.pidfd, SIGTERM);
    if (!ends_within(keeper.pidfd, kKeeper_s)) kill_now(keeper.pid, keeper.pidfd);
  }
  if (supervisor && !has_ended(supervisor.pidfd)) {
    log::warning("the supervisor of rig '{}' (pid {}) hangs; killed", name, supervisor.pid);
    send_signal(supervisor.pidfd, SIGKILL);
    ends_within(supervisor.pidfd, 1);
  }
  return {std::max(found, end_services(name, kServicesEnd_s, before_ns)),
          static_cast<bool>(keeper)};
}

/// Whether no process of the rig is left that was started before this time.
Result<void> seen_dark(const std::string& name, std::int64_t before_ns) {
  auto left = find_services(name);
  std::erase_if(left, [&](const auto& process) { return process.epoch_ns > before_ns; });
  if (left.empty()) return {};
  std::vector<std::string> names;
  for (const auto& process : left)
    names.push_back(fmt::format("{} (pid {})", process.service, process.pid));
  return fail(
      Errc::unavailable,
      fmt::format("processes of rig '{}' are still alive, and there may be light: {}; `sudo "
                  "kill -9` with their pids may end them",
                  name, join(names, ", ")));
}

}  // namespace

std::string describe(const StopReport& report, const std::string& name) {
  if (report.by_supervisor || report.ended == 0) return "the rig has stopped";
  return fmt::format("rig '{}' had no supervisor that answered; processes ended: {}", name,
                     report.ended);
}

Result<StopReport> stop_rig(const std::string& name) {
  const auto address = control::address_of(name);
  if (!address) return tl::make_unexpected(address.error());
  const auto before_ns = now_ns();
  StopReport report;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto answer = control::ask_with_descriptors(
        name, {.verb = control::Verb::down, .service = {}, .backend = {}}, kPatience);
    if (!answer && answer.error().code == Errc::bad_config)
      return tl::make_unexpected(answer.error());
    if (answer) {
      report.by_supervisor = true;
      report.ended += end_services(name, kServicesEnd_s, before_ns);
      return seen_dark(name, before_ns).map([&] { return report; });
    }
    const auto supervisor = open_process(control::listener_of(*address));
    const auto forced = end_by_force(name, supervisor, before_ns);
    report.ended += forced.ended;
    if (forced.had_keeper || !supervisor_comes_back(name)) break;
  }
  if (const auto dark = seen_dark(name, before_ns); !dark) return tl::make_unexpected(dark.error());
  if (control::has_supervisor(name))
    return fail(Errc::unavailable,
                fmt::format("rig '{}' is started again and again; is it a unit of systemd? "
                            "`systemctl --user stop handcast-{}` stops that",
                            name, name));
  return report;
}

}  // namespace handcast::supervisor
