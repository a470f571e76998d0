// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "ipc/ring/protocol.hpp"
#include "ipc/ring/reader_attachment.hpp"

namespace handcast::ipc {

/// A message in hand, as bytes: leased where it lies, or copied into a buffer. Ends its lease or
/// gives its buffer back when it dies, on whichever thread.
class Held {
 public:
  Held() = default;
  Held(std::shared_ptr<ReaderAttachment> attachment, const Lease& lease, const Taken& taken)
      : attachment_(std::move(attachment)),
        bytes_(attachment_->segment().slot_at(lease.slot)),
        lease_(lease),
        taken_(taken) {}
  Held(std::shared_ptr<ReaderAttachment> attachment, Buffer& buffer, const Taken& taken)
      : attachment_(std::move(attachment)),
        bytes_(buffer.data()),
        buffer_(&buffer),
        taken_(taken) {}
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
  ~Held() { let_go(); }

  const std::byte* bytes() const { return bytes_; }  ///< null: nothing in hand
  const Taken& taken() const { return taken_; }
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
