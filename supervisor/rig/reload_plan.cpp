// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/reload_plan.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "config/live/live_board.hpp"
#include "config/live/live_values.hpp"
#include "config/settings/settings.hpp"
#include "supervisor/spec/catalogue.hpp"
#include "supervisor/spec/fingerprint.hpp"

namespace handcast::supervisor {
namespace {

/// True if a restart may help although the settings have not changed: the cause of the failure may
/// have been removed.
bool has_given_up(const Service& service) {
  return service.state() == State::failed || service.state() == State::degraded;
}

/// The wanted rig with the back ends set by `handcast swap`, except for services whose back end
/// `wanted` changes.
config::Rig with_swaps(const LiveRig& rig, config::Rig wanted) {
  for (const auto& service : rig.services.all()) {
    const auto& name = service->spec().name;
    const auto before = backend_of(name, rig.config);
    const bool swapped = service->spec().backend != before;
    if (swapped && backend_of(name, wanted) == before)
      wanted = with_backend(std::move(wanted), name, service->spec().backend);
  }
  return wanted;
}

/// The applied rig with its live settings. Errors: there are none, or they do not fit.
Result<config::Rig> as_it_runs(const LiveRig& rig) {
  const auto fd = daemon::find_ring(rig.rings.descriptors(), msg::kLiveSettings);
  if (!fd) return fail(Errc::unavailable, "no ring");
  auto ring = ipc::Segment::open(UniqueFd(::dup(*fd)));
  if (!ring) return tl::make_unexpected(ring.error());
  const auto live = config::LiveBoard(std::move(*ring), {}, {}).now();
  if (!live) return tl::make_unexpected(live.error());
  return config::with_live(rig.config, live->values.view());
}

/// The wanted rig, with the applied rig's values of the live settings that have the wanted ones
/// already, e.g. after `handcast save`: such a setting restarts nobody.
config::Rig without_what_runs(const LiveRig& rig, config::Rig wanted) {
  auto running = as_it_runs(rig);
  if (!running) return wanted;
  auto applied = rig.config;
  const auto before = config::list_settings(applied), now = config::list_settings(*running),
             next = config::list_settings(wanted);
  std::string kept;
  for (std::size_t s = 0; s < next.size(); ++s)
    for (std::size_t i = 0; i < next[s].settings.size(); ++i) {
      const auto& setting = next[s].settings[i];
      const auto value = config::print_value(setting),
                 old = config::print_value(before[s].settings[i]);
      const bool runs = setting.effect == config::Effect::live &&
                        value == config::print_value(now[s].settings[i]);
      if (runs && value != old) kept += fmt::format("{} = {}\n", setting.path, old);
    }
  return kept.empty() ? wanted : config::with_live(wanted, kept).value_or(wanted);
}

}  // namespace

ReloadPlan plan_reload(const LiveRig& rig, config::Rig wanted, bool revives) {
  ReloadPlan plan;
  wanted = without_what_runs(rig, std::move(wanted));
  plan.specs = services_of(with_swaps(rig, wanted), rig.catalogue);
  plan.changed = config::print_rig(wanted) != config::print_rig(rig.config);
  plan.config = std::move(wanted);
  for (const auto& service : rig.services.all())
    if (std::ranges::find(plan.specs, service->spec().name, &ServiceSpec::name) == plan.specs.end())
      plan.stopped.push_back(service->spec().name);
  for (const auto& spec : plan.specs) {
    const auto* service = rig.services.find(spec.name);
    if (!service) {
      plan.started.push_back(spec.name);
      continue;
    }
    const bool has_begun = service->first_start_ns().has_value();
    const bool is_stale =
        service->spec().fingerprint != spec.fingerprint || (revives && has_given_up(*service));
    if (has_begun && is_stale) plan.restarted.push_back(spec.name);
  }
  return plan;
}

Result<void> check_reload(const LiveRig& rig, const ReloadPlan& plan) {
  if (plan.config.name != rig.name)
    return fail(Errc::bad_config, fmt::format("the rig's name cannot change while it is up ('{}' "
                                              "to '{}'); use `handcast down --rig {}` and "
                                              "`handcast up`",
                                              rig.name, plan.config.name, rig.name));
  if (auto fits = rig.rings.check_sizes(rings_of(plan.specs), rig.name); !fits) return fits;
  for (const auto& spec : plan.specs) {
    const auto* service = rig.services.find(spec.name);
    if (!service || service->spec().backend == spec.backend) continue;
    if (auto known = check_backend(rig.catalogue, spec.name, spec.backend); !known) return known;
  }
  return {};
}

}  // namespace handcast::supervisor
