// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
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

/// Size in bytes of a message of `fixed` bytes followed by an image. The arguments may come from
/// torn or hostile memory: if the size overflows, the result is the largest size_t, which fits no
/// slot.
constexpr std::size_t bytes_with_tail(std::size_t fixed, std::size_t width, std::size_t height,
                                      std::size_t bytes_per_pixel) {
  std::size_t pixels = 0, tail = 0, all = 0;
  const bool too_large = __builtin_mul_overflow(width, height, &pixels) ||
                         __builtin_mul_overflow(pixels, bytes_per_pixel, &tail) ||
                         __builtin_add_overflow(fixed, tail, &all);
  return too_large ? std::numeric_limits<std::size_t>::max() : all;
}

/// The inputs of one projector frame: the newest of each kind when the frame was begun. All times
/// are CLOCK_MONOTONIC; 0 means that there was none.
struct MadeFrom {
  std::uint64_t image_id = 0;     ///< frame_id of the camera image
  std::int64_t image_ns = 0;      ///< the middle of its exposure
  std::int64_t pose_ns = 0;       ///< the sample time of the newest tracker sample
  std::int64_t landmarks_ns = 0;  ///< the exposure of the image that was searched for landmarks
};

}  // namespace handcast::msg
