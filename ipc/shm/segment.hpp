// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/msg/header.hpp"
#include "ipc/shm/layout.hpp"

namespace handcast::ipc {

/// The parameters of a ring.
struct RingSpec {
  std::string stream;             ///< name of the stream, e.g. "camera.frames"
  std::uint64_t type_hash = 0;    ///< msg::type_hash<T>() of the message type
  std::size_t payload_bytes = 0;  ///< size of the largest message, tail included
  int slots = 4;                  ///< kMinSlots .. kMaxSlots
  /// Reuse the oldest slot instead of the most recently freed one, so that next() and at() of a
  /// reader find past messages.
  bool keep_history = false;

  /// The parameters of a ring of messages of type T.
  template <class T>
  static RingSpec of(std::string stream, int slots, bool keep_history,
                     std::size_t payload_bytes = sizeof(T)) {
    return {std::move(stream), msg::type_hash<T>(), payload_bytes, slots, keep_history};
  }
};

/// The access rights of a mapping. They protect against accidents only: a process of the same user
/// can map the memory again.
enum class Access {
  write,  ///< for writers: everything but the header is writable
  read,   ///< for readers: the control words and tallies are writable, the messages are not
  look,   ///< for observers: nothing is writable
};

/// The shared memory of one ring: a memfd without a name, sealed with F_SEAL_SHRINK and
/// F_SEAL_GROW. The supervisor creates it and passes the descriptor, which is close-on-exec, to
/// each service that it starts. The memory is mapped as long as this object exists. Const
/// functions: any thread.
class Segment {
 public:
  /// Creates, sizes, seals and initialises the memory of a ring. Errors: bad_config (name or sizes
  /// out of range), unavailable (no memory or descriptor).
  static Result<Segment> create(const RingSpec& spec);
  /// Takes ownership of `fd` and maps the ring behind it. A read-only descriptor gives a mapping
  /// with Access::look, any other one Access::write. Errors: bad_data (not a ring, not sealed,
  /// owned by another user, other layout version, other boot, or inconsistent sizes; the sentence
  /// says which), unavailable (no memory to map it).
  static Result<Segment> open(UniqueFd fd);

  /// Removes rights from this mapping. Errors: unavailable (it already has fewer rights than
  /// `access`, or the kernel refused).
  Result<void> restrict_to(Access access);

  /// Writes the header again if another process has overwritten it, so that the ring can be opened.
  /// Returns whether it has.
  bool repair_header() const;

  /// Moves the mapping; `other` is empty afterwards.
  /// @{
  Segment(Segment&&) noexcept;
  Segment& operator=(Segment&&) noexcept;
  /// @}
  ~Segment();

  /// The descriptor, owned by this object.
  int fd() const { return fd_.get(); }
  /// The first byte of the mapping; size() bytes are mapped.
  std::byte* data() const { return data_; }
  /// Size of the mapping in bytes.
  std::size_t size() const { return size_; }
  /// The parameters of the ring, as checked when it was opened: see RingSpec.
  /// @{
  std::string stream() const;
  std::uint64_t type_hash() const;
  std::size_t payload_bytes() const;
  int slots() const;
  bool keep_history() const;
  /// @}
  /// When the ring was created, CLOCK_MONOTONIC.
  std::int64_t created_ns() const;

  /// The first byte of a slot; `slot` must be within 0 .. slots() - 1.
  std::byte* slot_at(int slot) const;
  /// Checks that the ring carries this message type: `layout` is its name, `type_hash` its hash,
  /// `bytes` its size without a tail. Errors: bad_data (the type differs, or the slots are too
  /// small).
  Result<void> require(std::string_view layout, std::uint64_t type_hash, std::size_t bytes) const;

 private:
  Segment(UniqueFd fd, std::byte* data, const SegmentHeader& header, Access rights);
  void unmap();

  UniqueFd fd_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  Access rights_ = Access::write;
  /// A copy of the header made when it was checked: the shared one may be overwritten by others.
  SegmentHeader header_;
};

}  // namespace handcast::ipc
