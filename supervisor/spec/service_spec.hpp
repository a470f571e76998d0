// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/rig.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::supervisor {

/// A service of a rig as the supervisor knows it.
struct ServiceSpec {
  std::string name;        ///< "camera": the program is handcast-camera
  std::string stream;      ///< the ring it publishes; "" for none
  std::string backend;     ///< as the rig file has it; "" where the service has no back ends
  double asked_hz = 0;     ///< the rate asked of it; 0 where it runs as fast as it can
  std::string asked_of{};  ///< the back end that rate is asked of; "" for any
  std::vector<std::string> needs{};  ///< services that must be ready (or have given up) before this
                                     ///< one is started the first time
  config::Process process{};
  std::string fingerprint{};  ///< of the settings it is started with
};

/// The services a rig needs, in the order in which each needs only those before it.
std::vector<ServiceSpec> services_of(const config::Rig& rig);

/// The rings of these services: what each publishes, and its stage marks.
std::vector<ipc::RingSpec> rings_of(const std::vector<ServiceSpec>& services);

}  // namespace handcast::supervisor
