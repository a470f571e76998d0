// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/reload.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/control/control_message.hpp"
#include "supervisor/succession/systemd.hpp"

namespace handcast::supervisor {
namespace {

/// Added to the time limits of a service for stopping and becoming ready.
constexpr double kGrace_s = 1;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

bool has_settled(const Service& service) {
  return service.state() != State::starting && service.state() != State::stopping;
}

}  // namespace

// The applied rig is stored last: the steps before it have no visible effect, those after it cannot
// fail.
Result<Reload> Reload::begin(LiveRig& rig, config::Rig wanted, bool revives) {
  auto plan = plan_reload(rig, std::move(wanted), revives);
  if (auto possible = check_reload(rig, plan); !possible)
    return tl::make_unexpected(possible.error());
  const auto rings = rig.make_rings(plan.specs);
  if (!rings) return tl::make_unexpected(rings.error());
  store_with_systemd(*rings);
  if (auto stored = rig.store_applied(plan.config); !stored)
    return tl::make_unexpected(stored.error());

  Reload reload(rig, std::move(plan));
  reload.apply();
  return reload;
}

Reload::Reload(LiveRig& rig, ReloadPlan plan) : rig_(&rig), plan_(std::move(plan)) {}

void Reload::apply() {
  rig_->config = plan_.config;
  rig_->take_settings(plan_.config);
  for (std::size_t place = 0; place < plan_.specs.size(); ++place) {
    const auto& spec = plan_.specs[place];
    if (auto* service = rig_->services.find(spec.name))
      service->update(spec);
    else
      rig_->services.add(spec, place);
  }
  waiting_ = plan_.restarted;
  waiting_.insert(waiting_.end(), plan_.started.begin(), plan_.started.end());
  for (const auto& name : plan_.stopped) rig_->services.find(name)->stop();
}

bool Reload::advance(std::int64_t now) {
  note_what_has_settled(now);
  begin_what_may(now);
  const bool have_stopped = std::ranges::all_of(plan_.stopped, [this](const auto& name) {
    return rig_->services.find(name)->state() == State::stopped;
  });
  return have_stopped && waiting_.empty() && begun_.empty();
}

/// Starts the services whose needs have all settled.
void Reload::begin_what_may(std::int64_t now) {
  const auto& launch = rig_->launch;
  const auto until_ns = now + seconds_to_ns(launch.stop_s + launch.ready_s + kGrace_s);
  const auto in_the_way = [this](const auto& need) {
    return contains(waiting_, need) || begun_.contains(need);
  };
  for (const auto& name : std::vector<std::string>(waiting_)) {
    auto& service = *rig_->services.find(name);
    if (std::ranges::any_of(service.spec().needs, in_the_way)) continue;
    std::erase(waiting_, name);
    begun_[name] = until_ns;
    service.restart();
  }
}

void Reload::note_what_has_settled(std::int64_t now) {
  std::erase_if(begun_, [&](const auto& begun) {
    const auto& [name, until_ns] = begun;
    const auto& service = *rig_->services.find(name);
    if (!has_settled(service) && now < until_ns) return false;
    if (service.state() != State::ready)
      failures_.push_back(fmt::format("{} is {} with the new settings: {}", name,
                                      name_of(service.state()), service.log().last_sentence()));
    return true;
  });
}

nlohmann::json Reload::finish() {
  for (const auto& name : plan_.stopped) rig_->services.remove(name);
  auto answer = failures_.empty() ? control::success() : control::failure(join(failures_, "\n"));
  answer["changed"] = plan_.changed;
  answer["restarted"] = plan_.restarted;
  answer["started"] = plan_.started;
  answer["stopped"] = plan_.stopped;
  answer["untouched"] = nlohmann::json::array();
  for (const auto& service : rig_->services.all()) {
    const auto& name = service->spec().name;
    if (!contains(plan_.restarted, name) && !contains(plan_.started, name))
      answer["untouched"].push_back(name);
  }
  log::info("rig '{}' reloaded; restarted: {}", rig_->name,
            plan_.restarted.empty() ? "nothing" : join(plan_.restarted, ", "));
  return answer;
}

}  // namespace handcast::supervisor
