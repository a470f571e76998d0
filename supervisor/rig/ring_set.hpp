// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "ipc/daemon/handover.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/succession/saved_rig.hpp"

namespace handcast::supervisor {

/// The rings of a rig: their memory and the descriptors that the services inherit.
class RingSet {
 public:
  /// Creates the missing rings of `wanted`, all or none, and returns them. Errors: unavailable,
  /// bad_config.
  Result<daemon::Rings> add(const std::vector<ipc::RingSpec>& wanted);
  /// Takes over the rings of an earlier supervisor.
  void adopt(std::vector<ipc::Segment> rings) { rings_ = std::move(rings); }

  /// Checks that existing rings have the message types of `wanted`. Errors: bad_config.
  Result<void> check_types(const std::vector<ipc::RingSpec>& wanted) const;
  /// Checks that existing rings have the sizes of `wanted`, which cannot change while the rig is
  /// up. Errors: bad_config, with a sentence about the rig `name`.
  Result<void> check_sizes(const std::vector<ipc::RingSpec>& wanted, std::string_view name) const;

  /// The descriptors by stream; owned by the object.
  daemon::Rings descriptors() const;
  /// The rings for a successor of the supervisor.
  std::vector<SavedRing> saved() const;
  /// Repairs the headers that a program outside the rig has overwritten: a service that starts
  /// later could not open its rings.
  void repair_headers() const;
  /// Frees the rows and leases of readers that died.
  void sweep_dead_rows() const;

 private:
  const ipc::Segment* find(std::string_view stream) const;

  std::vector<ipc::Segment> rings_;
};

}  // namespace handcast::supervisor
