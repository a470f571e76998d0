// SPDX-License-Identifier: Apache-2.0
// Takeover of the services and rings of a supervisor that died.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "supervisor/rig/live_rig.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {

/// Kills the daemons of earlier supervisors that are not taken over: spares, and services that were
/// started after the state was last saved.
void end_strays(const ExitReports& reports, const std::optional<AdoptedRig>& adopted,
                const std::filesystem::path& program_folder);

/// Takes over the rings. Errors: bad_config (their types or sizes do not fit `specs`); the services
/// are left as they are then.
Result<void> take_rings(AdoptedRig& adopted, LiveRig& rig, const std::vector<ServiceSpec>& specs);

/// Takes over the living services and logs which have died. Services that are not in the rig are
/// added to it; the next reload stops them.
void take_services(AdoptedRig adopted, LiveRig& rig);

}  // namespace handcast::supervisor
