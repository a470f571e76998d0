// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

namespace handcast::msg {

/// The first member of every message.
struct Header {
  std::uint64_t frame_id = 0;     ///< counts up at its source: a camera, a tracker, a projector.
                                  ///< Landmarks have the number of the image they were found in
  std::int64_t origin_ns = 0;     ///< CLOCK_MONOTONIC: the middle of the exposure, or the sensor's
                                  ///< sample time on the host's clock. What is derived from a
                                  ///< message keeps its origin
  std::int64_t published_ns = 0;  ///< when this message was published (set by the ring's writer)
};

/// Identifies the layout of a message type to whoever maps a ring: FNV-1a over name, version and
/// size. A message type declares `static constexpr std::string_view layout = "Name/version"`; raise
/// the version when fields change.
template <class T>
constexpr std::uint64_t type_hash() {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : T::layout) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return (hash ^ sizeof(T)) * 1099511628211ull;
}

}  // namespace handcast::msg
