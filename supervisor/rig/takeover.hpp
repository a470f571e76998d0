// SPDX-License-Identifier: Apache-2.0
// Takeover of the services and rings of a supervisor that died.
#pragma once
#include <string>
#include <vector>

#include "supervisor/rig/live_rig.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {

/// Kills the supervisor of the rig `name` if its keeper has died, so that another one can take over
/// the rig under a new keeper. Returns false if there is no such supervisor.
bool end_supervisor_without_keeper(const std::string& name);

/// Takes over the rings. Errors: bad_config (their types or sizes do not fit `specs`); the services
/// are left as they are then.
Result<void> take_rings(AdoptedRig& adopted, LiveRig& rig, const std::vector<ServiceSpec>& specs);

/// Takes over the living services and logs which have died. Services that are not in the rig are
/// added to it; the next reload stops them.
void take_services(AdoptedRig adopted, LiveRig& rig);

}  // namespace handcast::supervisor
