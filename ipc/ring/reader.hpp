#pragma once
#include <cstdint>
#include <memory>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/ring/ring_reader.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// One message as a reader holds it. Today a private copy, later a lease on the slot: either way valid and unchanging as
/// long as the Sample lives. Keep few of them at a time.
template <class T>
class Sample {
 public:
  const T& operator*() const { return *message_; }
  const T* operator->() const { return message_; }
  std::uint64_t sequence() const { return sequence_; }
  std::uint64_t epoch() const { return epoch_; }  ///< goes up by one each time the writer was replaced

  Sample(Sample&&) noexcept = default;
  Sample& operator=(Sample&&) noexcept = default;

 private:
  template <class>
  friend class Reader;
  explicit Sample(RingReader::Message&& message)
      : memory_(std::move(message.memory)),
        message_(reinterpret_cast<const T*>(memory_.get())),
        sequence_(message.sequence),
        epoch_(message.epoch) {}
  std::shared_ptr<std::byte> memory_;  ///< goes back to the reader's pool
  const T* message_ = nullptr;
  std::uint64_t sequence_ = 0, epoch_ = 0;
};

/// A reader of a ring, in its own process; it cannot slow the writer down. One thread. The first message it gets is the
/// newest one that is there (with next(), on a ring that keeps history: the oldest).
template <class T>
class Reader {
 public:
  /// Errors: bad_data (the ring is of another type), unavailable (all reader rows are taken).
  static Result<Reader> attach(Segment segment, Wait wait = Wait::futex) {
    auto ring = RingReader::attach(std::move(segment), shape_of<T>(), wait);
    if (!ring) return tl::make_unexpected(std::move(ring.error()));
    return Reader(std::move(*ring));
  }

  /// The message after the last one seen, in order; waits for it until the deadline. Messages overwritten meanwhile are
  /// skipped and counted. Errors: timeout, bad_data (the memory does not make sense).
  Result<Sample<T>> next(Deadline deadline) { return sample(ring_->next(deadline)); }
  /// The newest message not seen yet; waits for one until the deadline. Errors as for next.
  Result<Sample<T>> latest(Deadline deadline) { return sample(ring_->latest(deadline)); }
  /// The message whose header.origin_ns is nearest to `origin_ns` among those the ring still holds; does not change what
  /// has been seen. Errors: timeout (the ring is empty), bad_data.
  Result<Sample<T>> at(std::int64_t origin_ns) { return sample(ring_->at(origin_ns)); }

  std::uint64_t received() const { return ring_->received(); }
  std::uint64_t skipped() const { return ring_->skipped(); }  ///< never seen by next()/latest(): overwritten or passed over

 private:
  explicit Reader(std::unique_ptr<RingReader> ring) : ring_(std::move(ring)) {}
  static Result<Sample<T>> sample(Result<RingReader::Message>&& message) {
    if (!message) return tl::make_unexpected(std::move(message.error()));
    return Sample<T>(std::move(*message));
  }
  std::unique_ptr<RingReader> ring_;
};

}  // namespace handcast::ipc
