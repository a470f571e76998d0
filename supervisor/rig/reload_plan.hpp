// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "supervisor/rig/live_rig.hpp"

namespace handcast::supervisor {

/// What a reload is going to do. The names are those of services, as the person is told.
struct ReloadPlan {
  config::Rig config;              ///< the rig as the file has it now
  std::vector<ServiceSpec> specs;  ///< its services, with the back ends that were swapped
  bool changed = false;            ///< the file says something else than before
  std::vector<std::string> restarted, started, stopped;
};

/// Plans to make `wanted` the rig that is applied: services whose fingerprints changed are
/// restarted, and if `revives` is set also those that have given up. Changes nothing.
ReloadPlan plan_reload(const LiveRig& rig, config::Rig wanted, bool revives);

/// Whether a rig that is up can become what is planned. Changes nothing. Errors: bad_config, with a
/// sentence that says what to do instead; unavailable.
Result<void> check_reload(const LiveRig& rig, const ReloadPlan& plan);

}  // namespace handcast::supervisor
