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

/// What a ring is made for. `payload_bytes` is the largest message, tail included.
struct RingSpec {
  std::string stream;           ///< "camera.frames"
  std::uint64_t type_hash = 0;  ///< msg::type_hash<T>()
  std::size_t payload_bytes = 0;
  int slots = 4;
  bool keep_history = false;  ///< reuse the oldest slot instead of the most recently freed: next()
                              ///< and at() see back

  template <class T>
  static RingSpec of(std::string stream, int slots, bool keep_history,
                     std::size_t payload_bytes = sizeof(T)) {
    return {std::move(stream), msg::type_hash<T>(), payload_bytes, slots, keep_history};
  }
};

/// What a mapping allows. Against accidents only: a process of the same user can map anew.
enum class Access {
  write,  ///< all but the header may be written
  read,   ///< the control words and tallies may be written, the messages not: a reader's
  look,   ///< nothing may be written
};

/// The shared memory of one ring: a sealed memfd (SHRINK | GROW), without a name anywhere. Made by
/// the supervisor, inherited by the services (its descriptor is close-on-exec: whoever spawns a
/// service passes it on by hand); mapped as long as the object lives.
class Segment {
 public:
  /// Makes, sizes, seals and formats the memory of a ring. Errors: unavailable (memory,
  /// descriptors), bad_config (sizes).
  static Result<Segment> create(const RingSpec& spec);
  /// Maps the ring behind a descriptor (which is taken over). Errors: bad_data with a sentence that
  /// says what differs: not a ring, another user's, other layout version, other boot, impossible
  /// sizes, unsealed; unavailable (no memory to map it in). A descriptor that is only for reading
  /// gives a mapping to look at, no more.
  static Result<Segment> open(UniqueFd fd);

  /// Takes rights from this mapping, never gives any. Errors: unavailable (it has fewer already, or
  /// the kernel cannot).
  Result<void> restrict_to(Access access);

  Segment(Segment&&) noexcept;
  Segment& operator=(Segment&&) noexcept;
  ~Segment();

  int fd() const { return fd_.get(); }
  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::string stream() const;
  std::uint64_t type_hash() const;
  std::size_t payload_bytes() const;
  int slots() const;
  bool keep_history() const;
  std::int64_t created_ns() const;

  /// The first byte of a slot; `slot` must be within 0 .. slots() - 1.
  std::byte* slot_at(int slot) const;
  /// Errors: bad_data, where the ring is for another type of message or its slots are too small for
  /// one.
  Result<void> require(std::string_view layout, std::uint64_t type_hash, std::size_t bytes) const;

 private:
  Segment(UniqueFd fd, std::byte* data, const SegmentHeader& header, Access rights);
  void unmap();

  UniqueFd fd_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  Access rights_ = Access::write;
  SegmentHeader
      header_;  ///< as it was validated: what others do to the shared one changes no bound of ours
};

}  // namespace handcast::ipc
