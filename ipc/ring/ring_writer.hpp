// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ipc/base/result.hpp"
#include "ipc/ring/message.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/tally.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// What every Writer<T> is made of: the protocol on a mapped segment, messages as bytes.
class RingWriter {
 public:
  static Result<std::unique_ptr<RingWriter>> attach(Segment segment, const MessageShape& shape);

  int loan();  ///< kNoSlot where none is free, even after the rows of dead readers were cleared
  std::byte* bytes_of(int slot) const {
    return slots_ + static_cast<std::size_t>(slot) * stride_bytes_;
  }
  void publish(int slot);
  void abandon(int slot) { core_.abandon(slot); }
  void publish_copy(const std::byte* message, std::size_t bytes);

  std::size_t payload_bytes() const { return segment_.payload_bytes(); }
  std::uint64_t published() const { return published_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  RingWriter(Segment segment, UniqueFd lock);
  int loan_after_sweep();

  Segment segment_;
  UniqueFd lock_;  ///< an open file description of its own, which holds the writer lock as long as
                   ///< it is open
  WriterCore<RealAtomics> core_;
  std::byte* slots_;
  std::size_t stride_bytes_;
  WriterTally& tally_;
  std::uint64_t published_ = 0, dropped_ = 0;                ///< by this writer
  std::uint64_t published_before_ = 0, dropped_before_ = 0;  ///< by its predecessors
  std::int64_t next_sweep_ns_ = 0;
};

}  // namespace handcast::ipc
