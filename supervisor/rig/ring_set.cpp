// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/ring_set.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/log.hpp"
#include "ipc/ring/row_owner.hpp"
#include "supervisor/base/process.hpp"
#include "supervisor/succession/adoption.hpp"

namespace handcast::supervisor {
namespace {

/// The first difference between a ring and its specification, for a message; "" if there is none.
std::string difference(const ipc::Segment& ring, const ipc::RingSpec& wanted) {
  if (ring.slots() != wanted.slots)
    return fmt::format("{} slots, not {}", wanted.slots, ring.slots());
  if (ring.payload_bytes() != wanted.payload_bytes)
    return fmt::format("{} bytes a message, not {}", wanted.payload_bytes, ring.payload_bytes());
  return {};
}

}  // namespace

const ipc::Segment* RingSet::find(std::string_view stream) const {
  const auto found = std::ranges::find(rings_, stream, &ipc::Segment::stream);
  return found == rings_.end() ? nullptr : &*found;
}

Result<daemon::Rings> RingSet::add(const std::vector<ipc::RingSpec>& wanted) {
  std::vector<ipc::Segment> made;
  daemon::Rings descriptors;
  for (const auto& spec : wanted) {
    if (find(spec.stream)) continue;
    auto ring = make_ring(spec);
    if (!ring) return fail_in(fmt::format("ring {}", spec.stream), ring.error());
    descriptors.emplace_back(spec.stream, ring->fd());
    made.push_back(std::move(*ring));
  }
  std::ranges::move(made, std::back_inserter(rings_));
  return descriptors;
}

Result<void> RingSet::check_types(const std::vector<ipc::RingSpec>& wanted) const {
  for (const auto& spec : wanted)
    if (const auto* ring = find(spec.stream); ring && ring->type_hash() != spec.type_hash)
      return fail(Errc::bad_config,
                  fmt::format("ring '{}' belongs to another version of handcast", spec.stream));
  return {};
}

Result<void> RingSet::check_sizes(const std::vector<ipc::RingSpec>& wanted,
                                  std::string_view name) const {
  for (const auto& spec : wanted) {
    const auto* ring = find(spec.stream);
    const auto differs = ring ? difference(*ring, spec) : "";
    if (differs.empty()) continue;
    return fail(Errc::bad_config,
                fmt::format("ring '{}' would need {}, which cannot change while the rig is up; use "
                            "`handcast down --rig {}` and `handcast up`",
                            spec.stream, differs, name));
  }
  return {};
}

daemon::Rings RingSet::descriptors() const {
  daemon::Rings descriptors;
  for (const auto& ring : rings_) descriptors.emplace_back(ring.stream(), ring.fd());
  return descriptors;
}

std::vector<SavedRing> RingSet::saved() const {
  std::vector<SavedRing> saved;
  for (const auto& ring : rings_) saved.push_back({ring.stream(), inode_of(ring.fd()), ring.fd()});
  return saved;
}

void RingSet::repair_headers() const {
  for (const auto& ring : rings_)
    if (ring.repair_header())
      log::warning("another program had overwritten the header of the ring {}", ring.stream());
}

void RingSet::sweep_dead_rows() const {
  for (const auto& ring : rings_) ipc::sweep_dead_rows(ring);
}

}  // namespace handcast::supervisor
