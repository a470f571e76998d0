// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/reload.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/control/control_message.hpp"
#include "supervisor/rig/applied_rig.hpp"
#include "supervisor/spec/catalogue.hpp"
#include "supervisor/spec/fingerprint.hpp"
#include "supervisor/succession/systemd.hpp"

namespace handcast::supervisor {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

bool has_settled(const Service& service) {
  return service.state() != State::starting && service.state() != State::stopping;
}

}  // namespace

// Making the rings and the candidate changes nothing that a service sees.
Result<Reload> Reload::begin(LiveRig& rig, config::Rig wanted, bool revives) {
  auto plan = plan_reload(rig, std::move(wanted), revives);
  if (auto possible = check_reload(rig, plan); !possible)
    return tl::make_unexpected(possible.error());
  const auto rings = rig.make_rings(plan.specs);
  if (!rings) return tl::make_unexpected(rings.error());
  store_with_systemd(*rings);
  auto candidate = make_applied(plan.config);
  if (!candidate) return tl::make_unexpected(candidate.error());
  return Reload(rig, std::move(plan), std::move(*candidate));
}

Reload::Reload(LiveRig& rig, ReloadPlan plan, AppliedRig candidate)
    : rig_(&rig), plan_(std::move(plan)), candidate_(std::move(candidate)) {
  for (const auto& name : plan_.restarted)
    if (rig_->services.find(name)->works()) replaced_.push_back(name);
}

bool Reload::advance(std::int64_t now) {
  if (!applied_) {
    const auto progress = prepare();
    if (progress == Progress::preparing) return false;
    if (progress == Progress::prepared) apply(now);
    if (!applied_) return true;
  }
  note_what_has_settled(now);
  begin_what_may(now);
  const bool have_stopped = std::ranges::all_of(plan_.stopped, [this](const auto& name) {
    return rig_->services.find(name)->state() == State::stopped;
  });
  return have_stopped && waiting_.empty() && begun_.empty();
}

/// Prepares one replacement after the other, so that the start of many processes at once does not
/// disturb those that work.
Reload::Progress Reload::prepare() {
  for (std::size_t i = 0; i < replaced_.size(); ++i) {
    const auto& name = replaced_[i];
    if (i == begun_replacements_) {
      ++begun_replacements_;
      prepare(name);
    }
    const auto& service = *rig_->services.find(name);
    if (service.replacement_is_prepared()) continue;
    if (service.has_replacement()) return Progress::preparing;
    abandon(fmt::format("{} cannot work with the new settings: {}", name,
                        service.replacement_problem()));
    return Progress::failed;
  }
  return Progress::prepared;
}

void Reload::prepare(const std::string& name) {
  auto& service = *rig_->services.find(name);
  auto wanted = service.settings();
  wanted.spec = *std::ranges::find(plan_.specs, name, &ServiceSpec::name);
  if (wanted.spec.backend != wanted.swapped) wanted.swapped.clear();
  wanted.rig_fd = candidate_.file.get();
  const bool alone = is_exclusive(rig_->catalogue, name, service.spec().backend) &&
                     is_exclusive(rig_->catalogue, name, wanted.spec.backend);
  service.prepare(std::move(wanted), {.alone = alone}, false);
}

void Reload::abandon(const std::string& why) {
  for (const auto& name : replaced_) rig_->services.find(name)->abandon();
  failures_.push_back(why + "; nothing was changed");
}

void Reload::apply(std::int64_t now) {
  applied_ = true;
  rig_->config = plan_.config;
  rig_->use(std::move(candidate_));
  rig_->take_settings(plan_.config);
  for (std::size_t place = 0; place < plan_.specs.size(); ++place) {
    const auto& spec = plan_.specs[place];
    auto* service = rig_->services.find(spec.name);
    if (!service) {
      rig_->services.add(spec, place);
    } else if (contains(replaced_, spec.name)) {
      begun_[spec.name] = rig_->settled_by(now);
      service->hand_over();
      service->update(spec);  // even if the replacement dies before it takes over
    } else {
      service->update(spec);
    }
  }
  for (const auto* names : {&plan_.restarted, &plan_.started})
    for (const auto& name : *names)
      if (!contains(replaced_, name)) waiting_.push_back(name);
  for (const auto& name : plan_.stopped) rig_->services.find(name)->stop();
}

bool Reload::waits_for(const std::string& service) const {
  return begun_.contains(service) || (!applied_ && contains(replaced_, service));
}

/// Starts the services whose needs have all settled.
void Reload::begin_what_may(std::int64_t now) {
  const auto in_the_way = [this](const auto& need) {
    return contains(waiting_, need) || begun_.contains(need);
  };
  for (const auto& name : std::vector<std::string>(waiting_)) {
    auto& service = *rig_->services.find(name);
    if (std::ranges::any_of(service.spec().needs, in_the_way)) continue;
    std::erase(waiting_, name);
    begun_[name] = rig_->settled_by(now);
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
  if (!applied_) {
    log::warning("not reloaded: {}", join(failures_, "; "));
    return control::failure(join(failures_, "\n"));
  }
  for (const auto& name : plan_.stopped) rig_->services.remove(name);
  log::info("rig '{}' reloaded; restarted: {}", rig_->name,
            plan_.restarted.empty() ? "nothing" : join(plan_.restarted, ", "));
  return answer();
}

nlohmann::json Reload::answer() const {
  auto answer = failures_.empty() ? control::success() : control::failure(join(failures_, "\n"));
  answer["changed"] = plan_.changed;
  answer["restarted"] = plan_.restarted;
  answer["started"] = plan_.started;
  answer["stopped"] = plan_.stopped;
  answer["untouched"] = nlohmann::json::array();
  answer["pauses_ms"] = answer["swapped"] = nlohmann::json::object();
  for (const auto& service : rig_->services.all()) {
    const auto& name = service->spec().name;
    const bool is_restarted = contains(plan_.restarted, name);
    if (!is_restarted && !contains(plan_.started, name)) answer["untouched"].push_back(name);
    const auto pause_ms = is_restarted ? service->pause_ms() : std::nullopt;
    if (pause_ms) answer["pauses_ms"][name] = *pause_ms;
    const auto& backend = service->spec().backend;
    if (const auto in_file = backend_of(name, rig_->config); backend != in_file)
      answer["swapped"][name] = {{"backend", backend}, {"in_file", in_file}};
  }
  return answer;
}

}  // namespace handcast::supervisor
