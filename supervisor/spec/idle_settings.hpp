// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "config/rig.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {

/// The settings of a rig that differ from their defaults and that no service reads, because another
/// back end is chosen: a sentence for each service, e.g. "camera.v4l2.device has no effect, because
/// camera.backend is "aravis"". `settings`: those of --set; a back end that one of them chooses is
/// tried for once, and what the rest of the file says for another one is no mistake. Settings of
/// the twin are left out, because the simulator reads them.
std::vector<std::string> idle_settings(const config::Rig& rig, const Catalogue& catalogue,
                                       const std::vector<std::string>& settings);

}  // namespace handcast::supervisor
