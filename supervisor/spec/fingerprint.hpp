// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "config/rig.hpp"

namespace handcast::supervisor {

/// A short text that changes when a setting changes on which the service depends: those of its own
/// section and of the sections it reads (the twin's for every back end named twin, the cascade's
/// for the projector, …). What only the supervisor reads
/// ([supervisor], and of [X.process] the standby) is not in it.
std::string fingerprint_of(std::string_view service, const config::Rig& rig);

/// The back end that the rig asks for; "" for a service without back ends.
std::string backend_of(std::string_view service, const config::Rig& rig);
/// The rig with another back end of a service.
config::Rig with_backend(config::Rig rig, std::string_view service, const std::string& backend);

}  // namespace handcast::supervisor
