// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

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

}  // namespace handcast::supervisor
