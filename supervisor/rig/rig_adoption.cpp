// SPDX-License-Identifier: Apache-2.0
// What a supervisor does first: it takes over what one that died has left, or makes everything
// anew.
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"
#include "ipc/daemon/contract.hpp"
#include "supervisor/rig/rig_runner.hpp"
#include "supervisor/spec/service_spec.hpp"

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

/// Daemons among the keeper's children are what earlier supervisors have left. What is not taken
/// over (a spare, a service that was started an instant before the end and noted nowhere) would
/// only be in the way. Who became a keeper by exec has other children too.
void end_strays(const ExitReports& reports, const std::optional<AdoptedRig>& adopted,
                const std::filesystem::path& program_folder) {
  const auto keeper = reports.keeper();
  if (keeper < 0) return;
  const auto children = children_of(keeper);
  if (reports.keeper() != keeper) return;  // it died, and these may be anybody's
  for (const auto pid : children) {
    const auto is_it = [&](const AdoptedProcess& process) { return process.saved.pid == pid; };
    if (!is_a_daemon(pid, program_folder) ||
        (adopted && std::ranges::any_of(adopted->services, is_it)))
      continue;
    ::kill(-pid, SIGKILL);
    ::kill(pid, SIGKILL);
  }
}

/// What makes a ring useless to this program; empty if nothing does.
Result<void> check_types(const std::vector<ipc::Segment>& rings,
                         const std::vector<ipc::RingSpec>& wanted) {
  for (const auto& ring : rings) {
    const auto spec = std::ranges::find(wanted, ring.stream(), &ipc::RingSpec::stream);
    if (spec != wanted.end() && spec->type_hash != ring.type_hash())
      return fail(Errc::bad_config, fmt::format("ring '{}' is another version's", ring.stream()));
  }
  return {};
}

}  // namespace

Result<void> RigRunner::inherit_or_make(const config::Rig& rig) {
  auto adopted = adopt(name_);
  if (!adopted) return tl::make_unexpected(adopted.error());
  reports_.read();
  end_strays(reports_, *adopted, launch_.program_folder);
  if (!*adopted) return make_rings(rig);
  auto taken = take_over(std::move(**adopted), rig);
  if (!taken)
    return fail(
        taken.error().code,
        fmt::format(
            "what lives of rig '{}' cannot be taken over: {}; `handcast down --rig {}` ends it",
            name_, taken.error().what, name_));
  return {};
}

/// Errors leave the services as they are.
Result<void> RigRunner::take_over(AdoptedRig adopted, const config::Rig& rig) {
  const auto specs = services_of(rig);
  continue_run(adopted.saved);
  for (const auto& ring : adopted.saved.rings) launch_.rings.emplace_back(ring.stream, ring.fd);
  rings_ = std::move(adopted.rings);
  if (auto fits = check_types(rings_, rings_of(specs)); !fits) return fits;
  if (auto fits = check_change(rig, specs); !fits) return fits;
  if (auto added = add_rings(specs); !added) return added;

  for (const auto& spec : specs) add_service(spec, services_.size());
  report_deaths(adopted);
  for (const auto& saved : adopted.saved.services) {
    const bool was_between =
        saved.state == State::starting || saved.state == State::stopping;  // it is begun anew
    if (const auto service = find(saved.name); service && !was_between) service->inherit(saved);
  }
  for (auto& process : adopted.services) {
    log::info("{} (pid {}) lives and is taken over", process.saved.name, process.saved.pid);
    if (!find(process.saved.name))
      add_service({.name = process.saved.name},
                  services_.size());  // not in the rig any more: reload stops it
  }
  for (auto& process : adopted.services) {
    const auto service = find(process.saved.name);
    service->adopt(std::move(process));
  }
  inherited_ = true;
  return {};
}

/// The rig is as old as its services' clock; --seconds counts from its start, or from now where a
/// person has just said it.
void RigRunner::continue_run(const SavedRig& saved) {
  launch_.epoch_ns = started_ns_ = saved.epoch_ns;
  if (!options_.is_successor && options_.seconds)
    *options_.seconds += ns_to_seconds(now_ns() - started_ns_);
  if (options_.out || saved.out.empty()) return;
  options_.out = saved.out;
  setenv(daemon::kOutVariable, saved.out.c_str(), 1);
}

void RigRunner::report_deaths(const AdoptedRig& adopted) {
  for (const auto& saved : adopted.saved.services) {
    const auto is_it = [&](const AdoptedProcess& process) {
      return process.saved.pid == saved.pid;
    };
    if (saved.pid == 0 || saved.state != State::ready ||
        std::ranges::any_of(adopted.services, is_it))
      continue;
    const auto exit = reports_.take(saved.pid).value_or(Exit{.unknown = true});
    log::warning("{} (pid {}) died while there was no supervisor ({})", saved.name, saved.pid,
                 exit.describe());
  }
}

}  // namespace handcast::supervisor
