// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "ipc/ring/protocol.hpp"
#include "ipc/ring/reader_attachment.hpp"

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

}  // namespace handcast::ipc
