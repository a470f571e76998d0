// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/rig.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {

/// A short text that changes when a setting changes that the service reads with its back end, as
/// the catalogue has it; the contents of small files count, too. Settings that only the supervisor
/// reads ([supervisor], and the standby of [X.process]) are left out. A service or back end that is
/// not in the catalogue reads everything: it is restarted too often rather than too seldom.
std::string fingerprint_of(std::string_view service, const config::Rig& rig,
                           const Catalogue& catalogue);

/// The back end that the rig asks for; "" for a service without back ends.
std::string backend_of(std::string_view service, const config::Rig& rig);
/// The rig with another back end of a service.
config::Rig with_backend(config::Rig rig, std::string_view service, const std::string& backend);

/// The settings of a rig that differ from their defaults and that no service reads, because another
/// back end is chosen: a sentence for each service, e.g. "camera.v4l2.device has no effect, because
/// camera.backend is "aravis"". `settings`: those of --set; a back end that one of them chooses is
/// tried for once, and what the rest of the file says for another one is no mistake. Settings of
/// the twin are left out, because the simulator reads them.
std::vector<std::string> idle_settings(const config::Rig& rig, const Catalogue& catalogue,
                                       const std::vector<std::string>& settings);

}  // namespace handcast::supervisor
