// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/succession/saved_rig.hpp"

namespace handcast::supervisor {

/// Creates a ring. Its descriptor gets a number that supervisors do not use for other descriptors,
/// because a successor must give the ring the same number. Errors: those of Segment::create();
/// unavailable (no more descriptors).
Result<ipc::Segment> make_ring(const ipc::RingSpec& spec);

/// A rig whose supervisor died.
struct AdoptedRig {
  SavedRig saved;  ///< the saved state
  /// The rings. Their descriptors have the numbers that the services know (saved.rings[i].fd), so
  /// that children can inherit them.
  std::vector<ipc::Segment> rings;
  std::vector<AdoptedProcess> services;  ///< the living services
};

/// Adopts the living services and the rings of the rig `name`; empty if there are none. Rings are
/// opened through the living services (/proc/PID/fd/N, whose inode is compared) or taken from
/// systemd's store; rows of dead readers are freed. Services that were not ready are killed.
/// Errors: bad_data, unavailable; the living services can only be stopped then (stop_orphans()).
Result<std::optional<AdoptedRig>> adopt(const std::string& name);
/// Stops all services of a rig without a supervisor; kills those that do not stop within `stop_s`.
/// Returns their number.
int stop_orphans(const std::string& name, double stop_s);
/// The names of this user's rigs whose services live without a supervisor, sorted.
std::vector<std::string> orphaned_rigs();
/// The orphaned rig called `name` ("": the only one). Empty if there is none, or if a supervisor,
/// started by its keeper, takes it over within a second.
std::optional<std::string> abandoned_rig(const std::string& name);

}  // namespace handcast::supervisor
