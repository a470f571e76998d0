// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "ipc/ring/reader.hpp"
#include "ipc/ring/real_atomics.hpp"
#include "ipc/ring/writer.hpp"

/// Messages and helpers for the tests of the rings.
namespace handcast::ipc::samples {

/// A small message.
struct Note {
  static constexpr std::string_view layout = "Note/1";  ///< see msg::type_hash()
  msg::Header header;                                   ///< see note()
  std::uint64_t value = 0;                              ///< see note()
};

/// A message of the same size with another name.
struct OtherNote {
  static constexpr std::string_view layout = "OtherNote/1";  ///< see msg::type_hash()
  msg::Header header;                                        ///< not used
  std::uint64_t value = 0;                                   ///< not used
};

/// A message with a tail of bytes.
struct Strip {
  static constexpr std::string_view layout = "Strip/1";  ///< see msg::type_hash()
  msg::Header header;                                    ///< set by the tests
  std::uint64_t tail_length = 0;                         ///< number of bytes in the tail
  /// The first byte of the tail.
  /// @{
  std::uint8_t* tail() { return reinterpret_cast<std::uint8_t*>(this + 1); }
  const std::uint8_t* tail() const { return reinterpret_cast<const std::uint8_t*>(this + 1); }
  /// @}
  /// Size of the message, tail included.
  std::size_t used_bytes() const { return sizeof(Strip) + tail_length; }
};

/// A message that is long enough to be read half written. All words follow from the first one.
struct Page {
  static constexpr std::string_view layout = "Page/1";  ///< see msg::type_hash()
  msg::Header header;                                   ///< frame_id: the seed
  std::array<std::uint64_t, 2048> words{};              ///< computed from the seed

  /// Writes all words.
  void fill(std::uint64_t seed) {
    header.frame_id = seed;
    header.origin_ns = static_cast<std::int64_t>(seed);
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = seed * 0x9e3779b97f4a7c15 + i;
  }
  /// True if all words belong to the seed in the header.
  bool whole() const {
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i] != header.frame_id * 0x9e3779b97f4a7c15 + i) return false;
    return true;
  }
};

/// The value of a result; ends the test program if it is an error.
template <class T>
T must(Result<T> result) {
  if (!result) {
    ADD_FAILURE() << result.error().what;
    std::abort();
  }
  return std::move(*result);
}

/// A new ring of messages of type T.
template <class T>
Segment make_ring(int slots, bool keep_history = false, std::size_t payload_bytes = sizeof(T)) {
  return must(Segment::create(RingSpec::of<T>("test.ring", slots, keep_history, payload_bytes)));
}

/// A copy of a descriptor.
inline UniqueFd duplicate(int fd) { return UniqueFd(::fcntl(fd, F_DUPFD_CLOEXEC, 0)); }

/// A second mapping of the same memory, as another process has it.
inline Segment again(const Segment& segment) {
  return must(Segment::open(duplicate(segment.fd())));
}

/// A message with this value, which is also its frame_id.
inline Note note(std::uint64_t value, std::int64_t origin_ns = 0) {
  return {{value, origin_ns, 0}, value};
}

/// A deadline for calls that must not wait.
inline const Deadline kNow = Deadline::now();

}  // namespace handcast::ipc::samples
