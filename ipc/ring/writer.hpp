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

/// A slot of shared memory, on loan to be filled in place. Published or given back (abandoned)
/// exactly once, while its Writer lives.
template <class T>
class Loan {
 public:
  T& operator*() const { return *message_; }
  T* operator->() const { return message_; }
  explicit operator bool() const { return message_ != nullptr; }
  /// Bytes after T for messages with a tail.
  std::size_t tail_bytes() const { return ring_->payload_bytes() - sizeof(T); }

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
  ~Loan() { abandon(); }  ///< abandons what was not published

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

/// The one writer of a ring. Never blocks, never waits for a reader. One thread.
template <class T>
class Writer {
 public:
  /// Takes the ring's writer lock (released by the kernel when the process dies) and continues
  /// after the last message of a predecessor. Errors: bad_data (the ring is of another type),
  /// unavailable (another writer lives).
  static Result<Writer> attach(Segment segment) {
    auto ring = RingWriter::attach(std::move(segment), shape_of<T>());
    if (!ring) return tl::make_unexpected(std::move(ring.error()));
    return Writer(std::move(*ring));
  }

  /// A slot with a default T in it. Empty (tests false) where every slot is leased: drop the own
  /// message.
  Loan<T> loan() { return {ring_.get(), ring_->loan()}; }
  /// Stamps header.published_ns and makes the message visible. An empty loan is nothing to publish.
  void publish(Loan<T>&& loan) {
    if (!loan) return;
    if (loan.ring_ != ring_.get()) std::abort();  // a slot of another ring
    ring_->publish(loan.take());
  }
  /// loan + copy + publish for small messages without a tail.
  void publish(const T& message) {
    static_assert(!HasTail<T>, "a message with a tail is written in place: loan()");
    ring_->publish_copy(reinterpret_cast<const std::byte*>(&message), sizeof(T));
  }

  std::uint64_t published() const { return ring_->published(); }  ///< by this writer
  std::uint64_t dropped() const { return ring_->dropped(); }      ///< for want of a slot

 private:
  explicit Writer(std::unique_ptr<RingWriter> ring) : ring_(std::move(ring)) {}
  std::unique_ptr<RingWriter> ring_;
};

}  // namespace handcast::ipc
