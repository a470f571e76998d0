// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/succession/saved_rig.hpp"

namespace handcast::supervisor {

/// A new ring under a number which a successor, that must give it the same one, has not used for
/// anything else before. Errors: as Segment::create.
Result<ipc::Segment> make_ring(const ipc::RingSpec& spec);

struct AdoptedRig {
  SavedRig saved;
  std::vector<ipc::Segment> rings;       ///< under the numbers they have in the services
                                         ///< (saved.rings[i].fd): children inherit them
  std::vector<AdoptedProcess> services;  ///< those that live
};

/// What still lives of the rig `name`; empty where nothing does. The rings come from the living
/// services (/proc/PID/fd/N, inode compared) or from systemd's store. Rows and locks of the dead
/// are made free. Errors: bad_data, unavailable: then what lives can only be stopped
/// (stop_orphans).
Result<std::optional<AdoptedRig>> adopt(const std::string& name);

/// Ends every service of a rig that has no supervisor, asking first. How many there were.
int stop_orphans(const std::string& name, double stop_s);

/// The rigs of this user whose services live while no supervisor answers for them, in the order of
/// their names.
std::vector<std::string> orphaned_rigs();
/// The one of them that `name` means (empty: the only one), if no supervisor takes it over within a
/// second, as one with a keeper does.
std::optional<std::string> abandoned_rig(const std::string& name);

}  // namespace handcast::supervisor
