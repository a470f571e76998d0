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

/// One message as a reader holds it, valid and unchanging as long as the Sample lives, also after
/// its Reader. A message with a tail (an image) is leased: read where it lies, while the writer
/// uses other slots; keep at most two of them at a time, more are copied. A small message is
/// copied. A sample may die on another thread than its reader's.
///
/// Its size was checked when it was taken. A leased one still lies in shared memory: no reader or
/// writer that goes through this library can change it meanwhile, but who does not trust the
/// writer's process asks for Hold::copy.
template <class T>
class Sample {
 public:
  const T& operator*() const { return *reinterpret_cast<const T*>(held_.bytes()); }
  const T* operator->() const { return &**this; }
  std::uint64_t sequence() const { return held_.taken().sequence; }
  std::uint64_t epoch() const {
    return held_.taken().epoch;
  }  ///< another one each time the writer was replaced
  bool leased() const { return held_.leased(); }

 private:
  template <class>
  friend class Reader;
  explicit Sample(Held&& held) : held_(std::move(held)) {}
  Held held_;
};

/// A reader of a ring, in its own process; it cannot slow the writer down. One thread. The first
/// message it gets is the newest one that is there (with next(), on a ring that keeps history: the
/// oldest).
template <class T>
class Reader {
 public:
  static constexpr Hold kHold = HasTail<T> ? Hold::lease : Hold::copy;

  /// The messages become read-only in this mapping. Errors: bad_data (the ring is of another type),
  /// unavailable (all reader rows are taken, no descriptor, no thread).
  static Result<Reader> attach(Segment segment, Wait wait = Wait::futex, Hold hold = kHold) {
    auto ring = RingReader::attach(std::move(segment), shape_of<T>(), wait, hold);
    if (!ring) return tl::make_unexpected(std::move(ring.error()));
    return Reader(std::move(*ring));
  }

  /// The message after the last one seen, in order; waits for it until the deadline. Messages
  /// overwritten meanwhile are skipped and counted. Errors: timeout, bad_data (the memory does not
  /// make sense).
  Result<Sample<T>> next(Deadline deadline) { return sample(ring_->next(deadline)); }
  /// The newest message not seen yet; waits for one until the deadline. Errors as for next.
  Result<Sample<T>> latest(Deadline deadline) { return sample(ring_->latest(deadline)); }
  /// The message whose header.origin_ns is nearest to `origin_ns` among those the ring still holds;
  /// does not change what has been seen. Errors: timeout (the ring is empty), bad_data.
  Result<Sample<T>> at(std::int64_t origin_ns) { return sample(ring_->at(origin_ns)); }

  /// With Wait::eventfd: readable when there may be something new; next() and latest() make it
  /// unreadable again when they find nothing. Put it into epoll, then call next(Deadline::now())
  /// until it times out. Else -1.
  int event_fd() const { return ring_->event_fd(); }

  std::uint64_t received() const { return ring_->received(); }
  std::uint64_t skipped() const {
    return ring_->skipped();
  }  ///< never seen by next()/latest(): overwritten or passed over
  std::uint64_t copied() const {
    return ring_->copied();
  }  ///< with Hold::lease: for want of a lease
  std::uint64_t revoked() const {
    return ring_->revoked();
  }  ///< leases taken away because this process was taken for dead

 private:
  explicit Reader(std::unique_ptr<RingReader> ring) : ring_(std::move(ring)) {}
  static Result<Sample<T>> sample(Result<Held>&& held) {
    if (!held) return tl::make_unexpected(std::move(held.error()));
    return Sample<T>(std::move(*held));
  }
  std::unique_ptr<RingReader> ring_;
};

}  // namespace handcast::ipc
