// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

namespace handcast::msg {

/// The first member of every message.
struct Header {
  /// Number of the frame, counted up by its source (camera, tracker or projector). Landmarks carry
  /// the number of the image they were found in.
  std::uint64_t frame_id = 0;
  /// CLOCK_MONOTONIC: the middle of the exposure, or the sample time of the sensor mapped to the
  /// host's clock. A message derived from another one keeps its origin.
  std::int64_t origin_ns = 0;
  /// CLOCK_MONOTONIC: when this message was published. Set by the writer of the ring.
  std::int64_t published_ns = 0;
};

/// Identifies the layout of a message type in the header of a ring: FNV-1a over name and version,
/// combined with the size. A message type declares `static constexpr std::string_view layout =
/// "Name/version"`; raise the version when fields change.
template <class T>
constexpr std::uint64_t type_hash() {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : T::layout) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return (hash ^ sizeof(T)) * 1099511628211ull;
}

}  // namespace handcast::msg
