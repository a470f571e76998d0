// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "ipc/ring/control_words.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"

/// Messages and shorthands for the tests of the rings.
namespace handcast::ipc::testing {

struct Note {
  static constexpr std::string_view layout = "Note/1";
  msg::Header header;
  std::uint64_t value = 0;
};

struct OtherNote {
  static constexpr std::string_view layout = "OtherNote/1";
  msg::Header header;
  std::uint64_t value = 0;
};

/// A message with a tail of bytes.
struct Strip {
  static constexpr std::string_view layout = "Strip/1";
  msg::Header header;
  std::uint64_t tail_length = 0;
  std::uint8_t* tail() { return reinterpret_cast<std::uint8_t*>(this + 1); }
  const std::uint8_t* tail() const { return reinterpret_cast<const std::uint8_t*>(this + 1); }
  std::size_t used_bytes() const { return sizeof(Strip) + tail_length; }
};

/// Long enough to be caught half written. Every word follows from the first.
struct Page {
  static constexpr std::string_view layout = "Page/1";
  msg::Header header;
  std::array<std::uint64_t, 2048> words{};

  void fill(std::uint64_t seed) {
    header.frame_id = seed;
    header.origin_ns = static_cast<std::int64_t>(seed);
    for (std::size_t i = 0; i < words.size(); ++i) words[i] = seed * 0x9e3779b97f4a7c15 + i;
  }
  bool whole() const {
    for (std::size_t i = 0; i < words.size(); ++i)
      if (words[i] != header.frame_id * 0x9e3779b97f4a7c15 + i) return false;
    return true;
  }
};

template <class T>
T must(Result<T> result) {
  if (!result) {
    ADD_FAILURE() << result.error().what;
    std::abort();
  }
  return std::move(*result);
}

template <class T>
Segment make_ring(int slots, bool keep_history = false, std::size_t payload_bytes = sizeof(T)) {
  return must(Segment::create(RingSpec::of<T>("test.ring", slots, keep_history, payload_bytes)));
}

inline UniqueFd duplicate(int fd) { return UniqueFd(::fcntl(fd, F_DUPFD_CLOEXEC, 0)); }

/// The same memory, mapped once more: what another process has.
inline Segment again(const Segment& segment) {
  return must(Segment::open(duplicate(segment.fd())));
}

inline Note note(std::uint64_t value, std::int64_t origin_ns = 0) {
  return {{value, origin_ns, 0}, value};
}

inline const Deadline kNow = Deadline::now();

}  // namespace handcast::ipc::testing
