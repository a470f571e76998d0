// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>

#include "ipc/base/result.hpp"
#include "ipc/ring/buffer_pool.hpp"
#include "ipc/ring/control_words.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/tally.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// A reader's place at a ring: the mapping, the row, the buffers for copies. Its reader and every
/// message in hand share it, so that no lease outlives its row or its memory.
class ReaderAttachment {
 public:
  /// Errors: unavailable (all rows are taken; the messages cannot be protected; the kernel does not
  /// tell when this process began).
  static Result<std::shared_ptr<ReaderAttachment>> take(Segment segment);
  ~ReaderAttachment();  ///< gives the row back
  ReaderAttachment(const ReaderAttachment&) = delete;
  ReaderAttachment& operator=(const ReaderAttachment&) = delete;

  const Segment& segment() const { return segment_; }
  ReaderCore<RealAtomics>& core() { return core_; }  ///< of the reader's thread
  BufferPool& buffers() { return buffers_; }         ///< of the reader's thread
  ReaderTally& tally() const { return reader_tally(segment_, row_); }
  /// Another core on the same row, with a place of its own in the stream: for a bridge's thread.
  ReaderCore<RealAtomics> another_core() const {
    return {control_words_of(segment_), row_, generation_of(owner_)};
  }

  void end(const Lease& lease);  ///< from any thread
  std::uint64_t revoked() const { return revoked_.load(std::memory_order_relaxed); }

 private:
  ReaderAttachment(Segment segment, int row, std::uint64_t owner);

  Segment segment_;
  int row_;
  std::uint64_t owner_;
  ReaderCore<RealAtomics> core_;
  BufferPool buffers_;
  std::atomic<std::uint64_t> revoked_{0};  ///< leases that were taken away while they were held
};

}  // namespace handcast::ipc
