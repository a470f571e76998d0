// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_look.hpp"

#include <set>

#include "ipc/base/clock.hpp"
#include "ipc/control/control_client.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

constexpr auto kPatience = std::chrono::seconds(1);  ///< `handcast top` cannot be quit meanwhile

/// True if a status is from another supervisor: its uptime is shorter, or its services differ.
bool is_another(const json& before, const json& now) {
  const auto services_in = [](const json& status) {
    std::set<std::string> names;
    if (const auto found = status.find("services"); found != status.end() && found->is_object())
      for (const auto& [name, entry] : found->items()) names.insert(name);
    return names;
  };
  if (!before.is_object() || before.value("uptime_s", 0.0) > now.value("uptime_s", 0.0))
    return true;
  return services_in(before) != services_in(now);
}

std::set<pid_t> pids_of(const RigLook& look) {
  std::set<pid_t> pids;
  if (look.status.contains("services"))
    for (const auto& [name, service] : look.status["services"].items()) {
      pids.insert(pid_in(service, "pid"));
      pids.insert(pid_in(service, "standby"));
    }
  for (const auto& ring : look.rings)
    for (const auto& reader : ring.readers) pids.insert(reader.pid);
  return pids;
}

}  // namespace

pid_t pid_in(const json& service, const char* key) {
  const auto found = service.find(key);
  return found != service.end() && found->is_number_integer() ? found->get<pid_t>() : 0;
}

RigLook RigWatcher::observe() {
  ask_supervisor();
  RigLook look{.rig = rig_, .taken_ns = now_ns(), .missing = missing_, .status = status_};
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
  const auto& status = answer->object["status"];
  const bool other = !missing_.empty() || is_another(status_, status);
  missing_.clear();
  status_ = status;
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
