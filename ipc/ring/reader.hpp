// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/ring/ring_reader.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// One message that a reader holds. It is valid and does not change as long as the Sample exists,
/// even after its Reader is destroyed. A message with a tail (an image) is leased: it is read in
/// its slot, while the writer uses other slots. A reader can hold two leased messages; further ones
/// are copied. A message without a tail is copied. A Sample may be destroyed on any thread.
///
/// The size of the message was checked when it was taken. A leased message still lies in shared
/// memory. No reader or writer that uses this library changes it meanwhile; if the process of the
/// writer is not trusted, use Hold::copy.
template <class T>
class Sample {
 public:
  /// The message; valid as long as this object.
  /// @{
  const T& operator*() const { return *reinterpret_cast<const T*>(held_.bytes()); }
  const T* operator->() const { return &**this; }
  /// @}
  /// Number of the message in its stream, given once in the life of the ring.
  std::uint64_t sequence() const { return held_.taken().sequence; }
  /// Number of the writer that published the message; it changes with each new writer.
  std::uint64_t epoch() const { return held_.taken().epoch; }
  /// True for a leased message, false for a copy.
  bool leased() const { return held_.leased(); }

 private:
  template <class>
  friend class Reader;
  explicit Sample(Held&& held) : held_(std::move(held)) {}
  Held held_;
};

/// A reader of a ring. It cannot slow the writer down. One thread. Its first message is the newest
/// one in the ring, or the oldest one if next() is called on a ring that keeps history.
template <class T>
class Reader {
 public:
  /// The default: messages with a tail are leased, others are copied.
  static constexpr Hold kHold = HasTail<T> ? Hold::lease : Hold::copy;

  /// Takes the segment, makes its messages read-only in this mapping, and claims a reader row.
  /// Errors: bad_data (the ring carries another type), unavailable (all reader rows are taken, no
  /// descriptor, or no thread).
  static Result<Reader> attach(Segment segment, Wait wait = Wait::futex, Hold hold = kHold) {
    auto ring = RingReader::attach(std::move(segment), shape_of<T>(), wait, hold);
    if (!ring) return tl::make_unexpected(std::move(ring.error()));
    return Reader(std::move(*ring));
  }

  /// Takes the segment, which may be mapped read-only, and reads it without a reader row: for
  /// programs outside the rig. Nothing is written to the ring, so any number of such readers fits
  /// and none can disturb the writer or another reader. Messages are copied. The writer does not
  /// wake such a reader: with Wait::futex and Wait::eventfd it looks every millisecond, and sees a
  /// message at once only if the writer wakes another reader. Errors: bad_data (the ring carries
  /// another type), unavailable (the memory cannot be protected, no descriptor, or no thread).
  static Result<Reader> watch(Segment segment, Wait wait = Wait::futex) {
    auto ring = RingReader::watch(std::move(segment), shape_of<T>(), wait);
    if (!ring) return tl::make_unexpected(std::move(ring.error()));
    return Reader(std::move(*ring));
  }

  /// The message after the last one seen, in order; waits for it until the deadline. Messages that
  /// were overwritten are skipped and counted. Errors: timeout, bad_data (the memory of the ring is
  /// inconsistent), unavailable (no memory for a copy).
  Result<Sample<T>> next(Deadline deadline) { return sample(ring_->next(deadline)); }
  /// The newest message not seen yet; waits for one until the deadline. Errors as for next().
  Result<Sample<T>> latest(Deadline deadline) { return sample(ring_->latest(deadline)); }
  /// The message whose header.origin_ns is nearest to `origin_ns` among those in the ring. Does not
  /// wait and does not affect next() and latest(). Errors: timeout (the ring is empty, or its
  /// messages change too fast), bad_data, unavailable (no memory for a copy).
  Result<Sample<T>> at(std::int64_t origin_ns) { return sample(ring_->at(origin_ns)); }

  /// Waits until next() or latest() may have a message; false if there is none at the deadline. A
  /// loop that runs for every frame asks first: unlike the error of next(), this allocates nothing.
  bool await(Deadline deadline) { return ring_->await(deadline); }

  /// With Wait::eventfd, a descriptor that is readable when there may be a new message; otherwise
  /// -1. Add it to an epoll set; when it is readable, call next(Deadline::now()) until it times
  /// out. next() and latest() make it unreadable again when they find no message. Owned by this
  /// object.
  int event_fd() const { return ring_->event_fd(); }

  /// Number of messages that next() and latest() have returned.
  std::uint64_t received() const { return ring_->received(); }
  /// Number of messages that next() and latest() did not return: overwritten, passed over or
  /// unusable.
  std::uint64_t skipped() const { return ring_->skipped(); }
  /// With Hold::lease, the number of messages that were copied because all leases were in use.
  std::uint64_t copied() const { return ring_->copied(); }
  /// Number of leases that were taken away because this process was mistaken for dead.
  std::uint64_t revoked() const { return ring_->revoked(); }

 private:
  explicit Reader(std::unique_ptr<RingReader> ring) : ring_(std::move(ring)) {}
  static Result<Sample<T>> sample(Result<Held>&& held) {
    if (!held) return tl::make_unexpected(std::move(held.error()));
    return Sample<T>(std::move(*held));
  }
  std::unique_ptr<RingReader> ring_;
};

}  // namespace handcast::ipc
