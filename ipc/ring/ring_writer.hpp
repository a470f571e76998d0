#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ipc/base/result.hpp"
#include "ipc/ring/message.hpp"
#include "ipc/ring/protocol.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// What every Writer<T> is made of: the protocol on a mapped segment, messages as bytes.
class RingWriter {
 public:
  static Result<std::unique_ptr<RingWriter>> attach(Segment segment, const MessageShape& shape);

  std::byte* loan();  ///< null where no slot is free
  void publish(std::byte* loaned);
  void abandon(std::byte* loaned);
  void publish_copy(const std::byte* message, std::size_t bytes);

  std::size_t payload_bytes() const { return segment_.payload_bytes(); }
  std::uint64_t published() const { return published_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  RingWriter(Segment segment, UniqueFd lock);
  int slot_of(const std::byte* loaned) const;

  Segment segment_;
  UniqueFd lock_;  ///< an open file description of its own, which holds the writer lock as long as it is open
  WriterCore<RealAtomics> core_;
  std::uint64_t published_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace handcast::ipc
