// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/rig.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/spec/catalogue.hpp"

namespace handcast::supervisor {

/// The specification of a service of a rig.
struct ServiceSpec {
  std::string name;         ///< "camera"; of an instance of a program, "camera2"
  std::string stream;       ///< the ring that it publishes; "" for none
  std::string backend;      ///< its back end; "" if the service has no back ends
  double wanted_hz = 0;     ///< the configured rate; 0 if it has none
  std::string wanted_of{};  ///< the back end that wanted_hz applies to; "" for all
  /// Services that must be ready, or have given up, before this one is started the first time.
  std::vector<std::string> needs{};
  config::Process process{};  ///< scheduling, memory and standby: [NAME.process]
  std::string fingerprint{};  ///< fingerprint of its settings: see fingerprint_of()
  /// The back end that takes the place of `backend` if a file of that is missing; "" for none.
  std::string fallback{};
  /// wanted_hz counts sub-frames, of which one drawing may light several.
  bool counts_sub_frames = false;
  /// Size in bytes of the largest message of the rings that it publishes; 0: as its stream says.
  std::size_t message_bytes = 0;
  /// Its program has the task --safe, for a device that must not stay as a dead service left it.
  bool has_safe_state = false;
  /// The service whose program it is an instance of: "camera" for camera2; "" for its own program.
  std::string instance_of{};
  double ready_s = 0;      ///< how long its start may take; 0: supervisor.ready_s
  bool shows_log = false;  ///< its last lines are of interest even if it is well
};

/// The begin of the command line of a service: its program in this folder, which --as tells what it
/// is if that is not its own name.
std::vector<std::string> command_of(const ServiceSpec& service,
                                    const std::filesystem::path& program_folder);

/// The services of a rig, in an order in which each needs only those before it.
std::vector<ServiceSpec> services_of(const config::Rig& rig, const Catalogue& catalogue);

/// The rings of these services: what each publishes, and its stage marks.
std::vector<ipc::RingSpec> rings_of(const std::vector<ServiceSpec>& services);

}  // namespace handcast::supervisor
