// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/tally.hpp"
#include "ipc/shm/layout.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// Private memory for one message, owned by a BufferPool.
class Buffer {
 public:
  /// The first byte, aligned to kLineBytes.
  std::byte* data() const { return data_.get(); }
  /// Returns the buffer to its pool. Any thread. The release store orders all reads of the buffer
  /// before its next use.
  void give_back() { in_use_.store(false, std::memory_order_release); }

 private:
  friend class BufferPool;
  struct Free {
    void operator()(std::byte* data) const {
      ::operator delete (data, std::align_val_t{kLineBytes});
    }
  };
  explicit Buffer(std::byte* data) : data_(data) {}

  std::unique_ptr<std::byte, Free> data_;
  std::atomic<bool> in_use_{true};
};

/// Reusable buffers of one size. Allocates only if more buffers are in use than ever before.
class BufferPool {
 public:
  /// A pool of buffers of at least `bytes` bytes; allocates nothing yet.
  explicit BufferPool(std::size_t bytes) : bytes_(round_up(bytes, kLineBytes)) {}

  /// A buffer that is not in use, valid until the pool is destroyed; null if there is no memory.
  /// One thread.
  Buffer* take() {
    for (const auto& buffer : buffers_)
      if (!buffer->in_use_.load(std::memory_order_acquire)) {
        buffer->in_use_.store(true, std::memory_order_relaxed);
        return buffer.get();
      }
    auto* data = static_cast<std::byte*>(
        ::operator new (bytes_, std::align_val_t{kLineBytes}, std::nothrow));
    if (!data) return nullptr;
    return buffers_.emplace_back(new Buffer(data)).get();
  }

 private:
  std::size_t bytes_;
  std::vector<std::unique_ptr<Buffer>> buffers_;
};

/// The longest sleep of a reader without a row, which nobody wakes.
inline constexpr std::int64_t kGlance_ns = 1'000'000;

/// The attachment of a reader to a ring: the mapping, the reader row if it has one, and the buffers
/// for copies. The reader and all messages that it holds share it, so no lease outlives its row or
/// its memory.
class ReaderAttachment {
 public:
  /// Takes the segment and claims a reader row. Errors: unavailable (all rows are taken, the
  /// messages cannot be protected, or the start time of this process cannot be read).
  static Result<std::shared_ptr<ReaderAttachment>> take(Segment segment);
  /// Takes the segment and claims no row: the mapping is read-only, messages can only be copied,
  /// and the counters are private. Errors: unavailable (the memory cannot be protected).
  static Result<std::shared_ptr<ReaderAttachment>> watch(Segment segment);
  ~ReaderAttachment();  ///< Releases the row.
  ReaderAttachment(const ReaderAttachment&) = delete;
  ReaderAttachment& operator=(const ReaderAttachment&) = delete;

  /// The mapped memory. Any thread.
  const Segment& segment() const { return segment_; }
  /// The reader's side of the protocol. The thread of the reader only.
  ReaderCore<RealAtomics>& core() { return core_; }
  /// The buffers for copies. The thread of the reader only.
  BufferPool& buffers() { return buffers_; }
  /// The counters of the row, or those of a reader without one. The thread of the reader only.
  ReaderTally& tally() { return has_row() ? reader_tally(segment_, row_) : own_tally_; }
  /// Sleeps until `core` may have a new message or `until_ns` is reached; may return early. Without
  /// a row it cannot request a wake-up, and sleeps at most kGlance_ns. `core` is core() or
  /// another_core(), on its thread.
  void sleep(ReaderCore<RealAtomics>& core, std::int64_t until_ns) const;
  /// A second core on the same row with its own position in the stream, for the thread of a
  /// WakeBridge.
  ReaderCore<RealAtomics> another_core() const {
    return {control_words_of(segment_), row_, generation_of(owner_)};
  }

  /// Ends a lease. If the lease was taken away, counts it and logs the first such case. Any thread.
  void end(const Lease& lease);
  /// Number of leases that were taken away while they were held. Any thread.
  std::uint64_t revoked() const { return revoked_.load(std::memory_order_relaxed); }

 private:
  static constexpr int kNoRow = -1;

  ReaderAttachment(Segment segment, int row, std::uint64_t owner);
  bool has_row() const { return row_ != kNoRow; }

  Segment segment_;
  int row_;
  std::uint64_t owner_;
  ReaderCore<RealAtomics> core_;
  BufferPool buffers_;
  ReaderTally own_tally_;
  std::atomic<std::uint64_t> revoked_{0};
};

}  // namespace handcast::ipc
