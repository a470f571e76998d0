// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/ring/ring_writer.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// A slot of shared memory in which a message is written in place. It is published with
/// Writer::publish(), or abandoned by the destructor; its Writer must still exist then.
template <class T>
class Loan {
 public:
  /// The message; only if this loan is not empty.
  /// @{
  T& operator*() const { return *message_; }
  T* operator->() const { return message_; }
  /// @}
  /// False if no slot was free, or the loan was published or moved from.
  explicit operator bool() const { return message_ != nullptr; }
  /// Bytes behind T, for messages with a tail.
  std::size_t tail_bytes() const { return ring_->payload_bytes() - sizeof(T); }

  /// Takes the slot of `other`, which is empty afterwards. Assignment abandons the old slot.
  /// @{
  Loan(Loan&& other) noexcept
      : ring_(other.ring_),
        slot_(std::exchange(other.slot_, kNoSlot)),
        message_(std::exchange(other.message_, nullptr)) {}
  Loan& operator=(Loan&& other) noexcept {
    std::swap(ring_, other.ring_);
    std::swap(slot_, other.slot_);
    std::swap(message_, other.message_);
    other.abandon();
    return *this;
  }
  /// @}
  ~Loan() { abandon(); }  ///< Abandons the slot if it was not published.

 private:
  template <class>
  friend class Writer;
  Loan(RingWriter* ring, int slot)
      : ring_(ring),
        slot_(slot),
        message_(slot == kNoSlot ? nullptr : new (ring->bytes_of(slot)) T{}) {}
  int take() {
    message_ = nullptr;
    return std::exchange(slot_, kNoSlot);
  }
  void abandon() {
    if (message_) ring_->abandon(take());
  }

  RingWriter* ring_;
  int slot_;
  T* message_;
};

/// The writer of a ring. A ring has one writer at a time. It never blocks and never waits for a
/// reader. One thread.
template <class T>
class Writer {
 public:
  /// Takes the segment and the writer lock of the ring, which the kernel releases when the process
  /// ends, and continues after the last message of the previous writer. Errors: bad_data (the ring
  /// carries another type, or its slots are too small), unavailable (another writer is attached and
  /// does not leave until the deadline or the next signal, or the memory is read-only).
  static Result<Writer> attach(Segment segment, Deadline until = Deadline::now()) {
    auto ring = RingWriter::attach(std::move(segment), shape_of<T>(), until);
    if (!ring) return tl::make_unexpected(std::move(ring.error()));
    return Writer(std::move(*ring));
  }

  /// A free slot with a default-constructed T in it. Empty (false) if all slots are leased: drop
  /// the message.
  Loan<T> loan() { return {ring_.get(), ring_->loan()}; }
  /// Sets header.published_ns and makes the message visible. Ignores an empty loan. Aborts if the
  /// loan belongs to another ring.
  void publish(Loan<T>&& loan) {
    if (!loan) return;
    if (loan.ring_ != ring_.get()) std::abort();
    ring_->publish(loan.take());
  }
  /// Publishes a copy of a message without a tail, or drops it if all slots are leased.
  void publish(const T& message) {
    static_assert(!HasTail<T>, "a message with a tail is written in place: loan()");
    ring_->publish_copy(reinterpret_cast<const std::byte*>(&message), sizeof(T));
  }

  /// Number of messages that this writer has published, and dropped for lack of a free slot.
  /// @{
  std::uint64_t published() const { return ring_->published(); }
  std::uint64_t dropped() const { return ring_->dropped(); }
  /// @}

 private:
  explicit Writer(std::unique_ptr<RingWriter> ring) : ring_(std::move(ring)) {}
  std::unique_ptr<RingWriter> ring_;
};

}  // namespace handcast::ipc
