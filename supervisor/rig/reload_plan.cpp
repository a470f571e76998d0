// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/reload_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace

ReloadPlan plan_reload(const LiveRig& rig, config::Rig wanted, bool revives) {
  ReloadPlan plan;
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
