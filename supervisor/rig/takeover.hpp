// SPDX-License-Identifier: Apache-2.0
// What a supervisor does with the services and rings that one that died has left.
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "supervisor/rig/live_rig.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {

/// Kills the daemons of earlier supervisors that are not taken over: a spare, or a service that was
/// started an instant before the end and is not in the saved state.
void end_strays(const ExitReports& reports, const std::optional<AdoptedRig>& adopted,
                const std::filesystem::path& program_folder);

/// Takes over the rings, if they suit the services. Errors: bad_config; the services are left as
/// they are.
Result<void> take_rings(AdoptedRig& adopted, LiveRig& rig, const std::vector<ServiceSpec>& specs);

/// Takes over the services. Those that are not in the rig any more are added to it: a reload stops
/// them. Those that died meanwhile are reported.
void take_services(AdoptedRig adopted, LiveRig& rig);

}  // namespace handcast::supervisor
