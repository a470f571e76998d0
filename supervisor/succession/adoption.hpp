// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/succession/process_discovery.hpp"
#include "supervisor/succession/saved_rig.hpp"
#include "supervisor/succession/state_memory.hpp"

namespace handcast::supervisor {

/// Creates a ring. Its descriptor gets a number that supervisors do not use for other descriptors,
/// because a successor must give the ring the same number. Errors: those of Segment::create();
/// unavailable (no more descriptors).
Result<ipc::Segment> make_ring(const ipc::RingSpec& spec);

/// A rig whose supervisor died.
struct AdoptedRig {
  SavedRig saved;     ///< the saved state
  StateMemory state;  ///< where it was saved
  /// The rings. Their descriptors have the numbers that the services know (saved.rings[i].fd), so
  /// that children can inherit them.
  std::vector<ipc::Segment> rings;
  std::vector<AdoptedProcess> services;  ///< the living services
};

/// Adopts the living services and the rings of the rig `name`; empty if there are none. The state
/// is that of a living service (/proc/PID/fd/N), or it comes from systemd's store, as do the rings,
/// whose inodes are compared; rows of dead readers are freed. All other processes of the rig's
/// services are killed: those that were not ready, standbys, and all of them if no state can be
/// read. Errors: unavailable (the rings cannot be opened); the living services can only be stopped
/// then (stop_rig()).
Result<std::optional<AdoptedRig>> adopt(const std::string& name);

/// The memory with the saved state that a service holds open. Errors: bad_data (it has none).
Result<StateMemory> state_memory_of(const FoundProcess& service);
/// The names of this user's rigs that have living services, sorted.
std::vector<std::string> rigs_with_services();
/// Those of them that have no supervisor.
std::vector<std::string> orphaned_rigs();
/// The saved state of a rig, from its living services. Empty if there is none.
std::optional<SavedRig> state_of(const std::string& name);

}  // namespace handcast::supervisor
