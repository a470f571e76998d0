// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>

#include "ipc/shm/layout.hpp"
#include "ipc/shm/segment.hpp"

/// The counters of a ring, read by observers (`handcast top`). The protocol never reads them. Each
/// line is written by one process; the counters of a dead writer or reader stay until its successor
/// continues or clears them.
namespace handcast::ipc {

/// The counters of the writer; they continue across all writers of the ring.
struct alignas(kLineBytes) WriterTally {
  std::atomic<std::uint64_t> published{0};  ///< messages published
  std::atomic<std::uint64_t> dropped{0};    ///< messages dropped for lack of a free slot
  /// Time between the last message of the previous writer and the first one of this writer; 0 if
  /// there was none before.
  std::atomic<std::int64_t> pause_ns{0};
};

/// The counters of the owner of a row; they start at zero with each owner.
struct alignas(kLineBytes) ReaderTally {
  std::atomic<std::uint64_t> received{0};  ///< messages taken by next() and latest()
  std::atomic<std::uint64_t> skipped{0};   ///< messages overwritten or passed over
  std::atomic<std::uint64_t> unusable{0};  ///< messages with an impossible size
  std::atomic<std::uint64_t> copied{0};    ///< messages copied because all leases were in use
  /// Sequence of the last message taken; before the first one, the sequence before it.
  std::atomic<std::uint64_t> seen{0};
  std::atomic<std::int64_t> age_ns{0};  ///< age of that message's origin when it was taken
};
static_assert(sizeof(WriterTally) == kLineBytes && sizeof(ReaderTally) == kLineBytes);

/// The counters of the writer in a mapped segment.
inline WriterTally& writer_tally(const Segment& segment) {
  return *reinterpret_cast<WriterTally*>(segment.data() + tally_offset(segment.slots()));
}
/// The counters of a reader row in a mapped segment.
inline ReaderTally& reader_tally(const Segment& segment, int row) {
  return *reinterpret_cast<ReaderTally*>(segment.data() + tally_offset(segment.slots()) +
                                         (1 + static_cast<std::size_t>(row)) * kLineBytes);
}

/// Resets the counters of a row for a new owner that has seen the messages up to `seen`.
inline void reset(ReaderTally& tally, std::uint64_t seen) {
  for (auto* count : {&tally.received, &tally.skipped, &tally.unusable, &tally.copied})
    count->store(0, std::memory_order_relaxed);
  tally.seen.store(seen, std::memory_order_relaxed);
  tally.age_ns.store(0, std::memory_order_relaxed);
}

}  // namespace handcast::ipc
