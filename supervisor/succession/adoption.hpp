// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/succession/saved_rig.hpp"

namespace handcast::supervisor {

/// A new ring. Its descriptor has a number that no supervisor uses for its own descriptors: a
/// successor must be able to give the ring the same number. Errors: as Segment::create; unavailable
/// (no descriptor left).
Result<ipc::Segment> make_ring(const ipc::RingSpec& spec);

/// What a supervisor that died has left.
struct AdoptedRig {
  SavedRig saved;
  /// Under the descriptors that they have in the services (saved.rings[i].fd): children inherit
  /// them.
  std::vector<ipc::Segment> rings;
  std::vector<AdoptedProcess> services;  ///< those that live
};

/// What still lives of the rig `name`; empty if nothing does. The rings are opened through the
/// living services (/proc/PID/fd/N, inode compared) or come from systemd's store. What dead readers
/// hold is freed. Errors: bad_data, unavailable; what lives can only be stopped then
/// (stop_orphans).
Result<std::optional<AdoptedRig>> adopt(const std::string& name);

/// Ends every service of a rig that has no supervisor: asks each to stop, and kills it after
/// `stop_s`. Returns how many there were.
int stop_orphans(const std::string& name, double stop_s);

/// The names of this user's rigs whose services live without a supervisor, sorted.
std::vector<std::string> orphaned_rigs();
/// The orphaned rig that `name` means ("": the only one), if no supervisor takes it over within a
/// second. A supervisor with a keeper does.
std::optional<std::string> abandoned_rig(const std::string& name);

}  // namespace handcast::supervisor
