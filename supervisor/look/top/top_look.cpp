// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_look.hpp"

#include <algorithm>
#include <set>

#include "ipc/base/clock.hpp"
#include "ipc/control/control_client.hpp"

namespace handcast::supervisor {
namespace {

constexpr auto kPatience = std::chrono::seconds(1);  ///< `handcast top` cannot be quit meanwhile

/// True if figures are of another supervisor: its uptime is shorter, or its services differ.
bool is_another(const std::optional<Figures>& before, const Figures& now) {
  const auto same_name = [](const auto& a, const auto& b) { return a.first == b.first; };
  return !before || before->uptime_s > now.uptime_s ||
         !std::ranges::equal(before->services, now.services, same_name);
}

std::set<pid_t> pids_of(const RigLook& look) {
  std::set<pid_t> pids;
  if (look.figures)
    for (const auto& [name, service] : look.figures->services)
      pids.insert({service.pid, service.standby_pid});
  for (const auto& ring : look.rings)
    for (const auto& reader : ring.readers) pids.insert(reader.pid);
  return pids;
}

}  // namespace

RigLook RigWatcher::observe() {
  ask_supervisor();
  RigLook look{.rig = rig_, .taken_ns = now_ns(), .missing = missing_, .figures = figures_};
  for (const auto& ring : rings_) look.rings.push_back(ring.look());
  for (const auto pid : pids_of(look))
    if (auto usage = usage_of(pid)) look.processes.emplace(pid, std::move(*usage));
  return look;
}

void RigWatcher::ask_supervisor() {
  auto answer = control::ask_with_descriptors(rig_, {.verb = control::Verb::status}, kPatience);
  if (!answer || !answer->object.contains("status") || !answer->object["status"].is_object()) {
    missing_ = answer ? "its answer is invalid" : answer.error().what;
    return;
  }
  auto figures = figures_in(answer->object["status"]);
  const bool other = !missing_.empty() || is_another(figures_, figures);
  missing_.clear();
  figures_ = std::move(figures);
  if (other) open_rings();
}

void RigWatcher::open_rings() {
  auto answer = control::ask_with_descriptors(rig_, {.verb = control::Verb::rings}, kPatience);
  if (!answer) {
    missing_ = answer.error().what;
    return;
  }
  rings_.clear();
  for (auto& fd : answer->descriptors) {
    auto ring = ipc::RingView::open(std::move(fd));
    if (ring)
      rings_.push_back(std::move(*ring));
    else
      missing_ = ring.error().what;
  }
}

}  // namespace handcast::supervisor
