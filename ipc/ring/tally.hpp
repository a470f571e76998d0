// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>

#include "ipc/shm/layout.hpp"
#include "ipc/shm/segment.hpp"

/// What a ring's users count for whoever looks on (`handcast top`): plain statistics. The protocol
/// never reads them, one process writes each line, and a dead writer's or reader's counts stay
/// until its successor continues or clears them.
namespace handcast::ipc {

/// Written by the writer; goes on counting over all writers of the ring.
struct alignas(kLineBytes) WriterTally {
  std::atomic<std::uint64_t> published{0};
  std::atomic<std::uint64_t> dropped{0};  ///< for want of a free slot
};

/// Written by the owner of a row, from zero.
struct alignas(kLineBytes) ReaderTally {
  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> skipped{0};   ///< overwritten or passed over before it was read
  std::atomic<std::uint64_t> unusable{0};  ///< messages that made no sense
  std::atomic<std::uint64_t> copied{0};    ///< of a reader in place: all leases were out
  std::atomic<std::uint64_t> seen{
      0};  ///< sequence of the last message taken; before the first: of the one before it
  std::atomic<std::int64_t> age_ns{0};  ///< of that message's origin, when it was taken
};
static_assert(sizeof(WriterTally) == kLineBytes && sizeof(ReaderTally) == kLineBytes);

inline WriterTally& writer_tally(const Segment& segment) {
  return *reinterpret_cast<WriterTally*>(segment.data() + tally_offset(segment.slots()));
}
inline ReaderTally& reader_tally(const Segment& segment, int row) {
  return *reinterpret_cast<ReaderTally*>(segment.data() + tally_offset(segment.slots()) +
                                         (1 + static_cast<std::size_t>(row)) * kLineBytes);
}

/// What the owner of a row starts with.
inline void reset(ReaderTally& tally, std::uint64_t seen) {
  for (auto* count : {&tally.received, &tally.skipped, &tally.unusable, &tally.copied})
    count->store(0, std::memory_order_relaxed);
  tally.seen.store(seen, std::memory_order_relaxed);
  tally.age_ns.store(0, std::memory_order_relaxed);
}

}  // namespace handcast::ipc
