// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <limits>

namespace handcast::msg {

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

}  // namespace handcast::msg
