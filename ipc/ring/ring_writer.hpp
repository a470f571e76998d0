// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/ring/message.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/tally.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// The untyped implementation of Writer<T>: the protocol on a mapped segment, with messages as
/// bytes. One thread.
class RingWriter {
 public:
  /// See Writer<T>::attach().
  static Result<std::unique_ptr<RingWriter>> attach(Segment segment, const MessageShape& shape,
                                                    Deadline until);

  /// A slot to write to; kNoSlot, and counted as dropped, if none is free even after the rows of
  /// dead readers were freed.
  int loan();
  /// The first byte of a slot.
  std::byte* bytes_of(int slot) const {
    return slots_ + static_cast<std::size_t>(slot) * stride_bytes_;
  }
  /// Stamps the message in a loaned slot and publishes it.
  void publish(int slot);
  /// Returns a loaned slot without a message.
  void abandon(int slot) { core_.abandon(slot); }
  /// Publishes a copy of `bytes` bytes, or drops the message if no slot is free.
  void publish_copy(const std::byte* message, std::size_t bytes);

  /// Size of a slot: the largest message in bytes.
  std::size_t payload_bytes() const { return segment_.payload_bytes(); }
  /// Number of messages that this writer has published, and that it has dropped for lack of a free
  /// slot.
  /// @{
  std::uint64_t published() const { return published_; }
  std::uint64_t dropped() const { return dropped_; }
  /// @}

 private:
  RingWriter(Segment segment, UniqueFd lock);
  int loan_after_sweep();

  Segment segment_;
  /// An open file description of its own, which holds the writer lock as long as it is open.
  UniqueFd lock_;
  WriterCore<RealAtomics> core_;
  std::byte* slots_;
  std::size_t stride_bytes_;
  WriterTally& tally_;
  std::uint64_t published_ = 0, dropped_ = 0;                ///< by this writer
  std::uint64_t published_before_ = 0, dropped_before_ = 0;  ///< by its predecessors
  std::int64_t last_before_ns_ = 0;  ///< when the last of them published last; 0: never
  std::int64_t next_sweep_ns_ = 0;
};

}  // namespace handcast::ipc
