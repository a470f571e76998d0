// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/rig.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {

/// The specification of a service of a rig.
struct ServiceSpec {
  std::string name;         ///< "camera": the program is handcast-camera
  std::string stream;       ///< the ring that it publishes; "" for none
  std::string backend;      ///< its back end; "" if the service has no back ends
  double wanted_hz = 0;     ///< the configured rate; 0 if it has none
  std::string wanted_of{};  ///< the back end that wanted_hz applies to; "" for all
  /// Services that must be ready, or have given up, before this one is started the first time.
  std::vector<std::string> needs{};
  config::Process process{};  ///< scheduling, memory and spare: [NAME.process]
  std::string fingerprint{};  ///< fingerprint of its settings: see fingerprint_of()
  /// The back end that takes the place of `backend` if a file of that is missing; "" for none.
  std::string fallback{};
  /// wanted_hz counts sub-frames, of which one drawing may light several.
  bool counts_sub_frames = false;
  /// Its program has the task --safe, for a device that must not stay as a dead service left it.
  bool has_safe_state = false;
};

/// The services of a rig, in an order in which each needs only those before it.
std::vector<ServiceSpec> services_of(const config::Rig& rig, const Catalogue& catalogue);

/// The rings of these services: what each publishes, and its stage marks.
std::vector<ipc::RingSpec> rings_of(const std::vector<ServiceSpec>& services);

}  // namespace handcast::supervisor
