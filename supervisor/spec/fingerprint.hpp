// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "config/rig.hpp"

namespace handcast::supervisor {

/// A short text that changes when a setting changes that the service reads: those of its own
/// section and of other sections (the twin's for every back end named twin, the cascade's for the
/// projector, and so on). Settings that only the supervisor reads ([supervisor], and the standby of
/// [X.process]) are left out.
std::string fingerprint_of(std::string_view service, const config::Rig& rig);

/// The back end that the rig asks for; "" for a service without back ends.
std::string backend_of(std::string_view service, const config::Rig& rig);
/// The rig with another back end of a service.
config::Rig with_backend(config::Rig rig, std::string_view service, const std::string& backend);

}  // namespace handcast::supervisor
