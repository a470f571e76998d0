// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/rig.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {

/// What the supervisor knows about a service of a rig before it is started.
struct ServiceSpec {
  std::string name;        ///< "camera": the program is handcast-camera
  std::string stream;      ///< the ring it publishes; "" for none
  std::string backend;     ///< as the rig file has it; "" where the service has no back ends
  double asked_hz = 0;     ///< the rate asked of it; 0 if it runs as fast as it can
  std::string asked_of{};  ///< the back end that the rate is asked of; "" for any
  /// Services that must be ready, or have given up, before this one is started the first time.
  std::vector<std::string> needs{};
  config::Process process{};
  std::string fingerprint{};  ///< of the settings it is started with
};

/// The services of a rig, in an order in which each needs only those before it.
std::vector<ServiceSpec> services_of(const config::Rig& rig, const Catalogue& catalogue);

/// The rings of these services: what each publishes, and its stage marks.
std::vector<ipc::RingSpec> rings_of(const std::vector<ServiceSpec>& services);

}  // namespace handcast::supervisor
