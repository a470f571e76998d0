// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "ipc/daemon/handover.hpp"
#include "ipc/shm/segment.hpp"
#include "supervisor/succession/saved_rig.hpp"

namespace handcast::supervisor {

/// The rings of a rig: their memory, under the descriptors that the services inherit.
class RingSet {
 public:
  /// Makes those of `wanted` that are not there, all or none of them, and returns them. Errors:
  /// unavailable, bad_config.
  Result<daemon::Rings> add(const std::vector<ipc::RingSpec>& wanted);
  /// Takes over the rings of an earlier supervisor.
  void adopt(std::vector<ipc::Segment> rings) { rings_ = std::move(rings); }

  /// Whether the rings that are there are of the types that are wanted. Errors: bad_config.
  Result<void> check_types(const std::vector<ipc::RingSpec>& wanted) const;
  /// Whether the rings that are there have the sizes that are wanted: a ring cannot change while
  /// the rig is up. Errors: bad_config, with a sentence about the rig `name`.
  Result<void> check_sizes(const std::vector<ipc::RingSpec>& wanted, std::string_view name) const;

  daemon::Rings descriptors() const;
  std::vector<SavedRing> saved() const;
  /// Frees what readers that died hold.
  void sweep_dead_rows() const;

 private:
  const ipc::Segment* find(std::string_view stream) const;

  std::vector<ipc::Segment> rings_;
};

}  // namespace handcast::supervisor
