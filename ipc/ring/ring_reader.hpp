// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/wait.hpp"
#include "ipc/ring/message.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/reader_attachment.hpp"
#include "ipc/ring/rhythm.hpp"
#include "ipc/ring/wake_bridge.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// A message that a reader holds, as bytes: leased in its slot, or copied into a buffer. The
/// destructor ends the lease or returns the buffer, on any thread.
class Held {
 public:
  Held() = default;
  /// A leased message.
  Held(std::shared_ptr<ReaderAttachment> attachment, const Lease& lease, const Taken& taken)
      : attachment_(std::move(attachment)),
        bytes_(attachment_->segment().slot_at(lease.slot)),
        lease_(lease),
        taken_(taken) {}
  /// A message that was copied into `buffer`.
  Held(std::shared_ptr<ReaderAttachment> attachment, Buffer& buffer, const Taken& taken)
      : attachment_(std::move(attachment)),
        bytes_(buffer.data()),
        buffer_(&buffer),
        taken_(taken) {}
  /// Takes the message of `other`, which is empty afterwards. Assignment releases the old one.
  /// @{
  Held(Held&& other) noexcept
      : attachment_(std::move(other.attachment_)),
        bytes_(std::exchange(other.bytes_, nullptr)),
        buffer_(other.buffer_),
        lease_(other.lease_),
        taken_(other.taken_) {}
  Held& operator=(Held&& other) noexcept {
    if (this == &other) return *this;
    let_go();
    attachment_ = std::move(other.attachment_);
    bytes_ = std::exchange(other.bytes_, nullptr);
    buffer_ = other.buffer_;
    lease_ = other.lease_;
    taken_ = other.taken_;
    return *this;
  }
  /// @}
  ~Held() { let_go(); }

  /// The first byte of the message; null if this object is empty.
  const std::byte* bytes() const { return bytes_; }
  /// The sequence and epoch of the message.
  const Taken& taken() const { return taken_; }
  /// True for a leased message, false for a copy.
  bool leased() const { return bytes_ && !buffer_; }

 private:
  void let_go() {
    if (!attachment_) return;
    if (buffer_)
      buffer_->give_back();
    else
      attachment_->end(lease_);
    attachment_.reset();
  }

  std::shared_ptr<ReaderAttachment> attachment_;
  const std::byte* bytes_ = nullptr;
  Buffer* buffer_ = nullptr;  ///< null: leased
  Lease lease_;
  Taken taken_;
};

/// How a reader holds a message.
enum class Hold {
  /// A private copy, for small messages.
  copy,
  /// The message in its slot, which the writer does not touch meanwhile; a copy if all leases of
  /// the row are in use.
  lease,
};

/// The untyped implementation of Reader<T>: the protocol on a mapped segment, with messages as
/// bytes. One thread.
class RingReader {
 public:
  /// See Reader<T>.
  /// @{
  static Result<std::unique_ptr<RingReader>> attach(Segment segment, const MessageShape& shape,
                                                    Wait wait, Hold hold);
  static Result<std::unique_ptr<RingReader>> watch(Segment segment, const MessageShape& shape,
                                                   Wait wait);

  Result<Held> next(Deadline deadline);
  Result<Held> latest(Deadline deadline);
  Result<Held> at(std::int64_t origin_ns);
  bool await(Deadline deadline);

  int event_fd() const { return bridge_ ? bridge_->fd() : -1; }

  std::uint64_t received() const { return received_; }
  std::uint64_t skipped() const { return attachment_->core().skipped() + unusable_; }
  std::uint64_t copied() const { return copied_; }
  std::uint64_t revoked() const { return attachment_->revoked(); }
  /// @}

 private:
  static Result<std::unique_ptr<RingReader>> over(
      Result<std::shared_ptr<ReaderAttachment>> attachment, const MessageShape& shape, Wait wait,
      Hold hold);
  RingReader(std::shared_ptr<ReaderAttachment> attachment, const MessageShape& shape, Wait wait,
             Hold hold);

  template <class Verb>
  Result<Held> take_until(Deadline deadline, const Verb& verb);
  template <class Verb>
  Result<Outcome> look(const Verb& verb, Held& held);
  template <class Verb>
  Result<Outcome> attempt(const Verb& verb, Held& held);
  template <class Verb>
  Result<Outcome> attempt_copy(const Verb& verb, Held& held);
  void copy_out(int slot, std::byte* to) const;
  Result<Held> checked(Held&& held) const;
  Result<Held> counted(Held&& held);
  void wait(Deadline deadline);
  void spin(std::int64_t until_ns) const;
  tl::unexpected<Error> fail_here(Errc code, std::string_view what) const;

  std::shared_ptr<ReaderAttachment> attachment_;
  MessageShape shape_;
  Wait wait_;
  Hold hold_;
  Rhythm rhythm_;
  std::uint64_t received_ = 0;
  std::uint64_t unusable_ = 0;
  std::uint64_t copied_ = 0;
  /// Only with Wait::eventfd. Its thread uses the attachment, so it is destroyed first.
  std::unique_ptr<WakeBridge> bridge_;
};

}  // namespace handcast::ipc
