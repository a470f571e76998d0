// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "supervisor/rig/live_rig.hpp"

namespace handcast::supervisor {

/// The steps of a reload.
struct ReloadPlan {
  config::Rig config;              ///< the new rig; live values that run already are not in it
  std::vector<ServiceSpec> specs;  ///< its services, with the back ends that were swapped
  bool changed = false;            ///< the new rig differs from the applied one
  /// Names of services.
  /// @{
  std::vector<std::string> restarted, started, stopped;
  /// @}
};

/// Plans a reload to the rig `wanted`. Services whose fingerprints changed are restarted; if
/// `revives` is set, failed and degraded ones are restarted, too. A live setting that has the
/// wanted value already restarts nobody. Changes nothing.
ReloadPlan plan_reload(const LiveRig& rig, config::Rig wanted, bool revives);

/// Checks that the plan can be applied while the rig is up. Changes nothing. Errors: bad_config,
/// with a sentence that names the remedy; unavailable.
Result<void> check_reload(const LiveRig& rig, const ReloadPlan& plan);

}  // namespace handcast::supervisor
