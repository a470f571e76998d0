// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace handcast::landmarks {

/// The number of pixels of each grey value.
using Histogram = std::array<std::uint32_t, 256>;

/// The histogram of 8-bit pixels. Counts into four tables in turn, so that equal neighbours do not
/// wait for each other's store.
inline Histogram histogram_of(std::span<const std::uint8_t> pixels) {
  std::array<Histogram, 4> parts{};
  std::size_t i = 0;
  for (; i + 4 <= pixels.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) ++parts[k][pixels[i + k]];
  for (; i < pixels.size(); ++i) ++parts[0][pixels[i]];
  for (std::size_t value = 0; value < parts[0].size(); ++value)
    parts[0][value] += parts[1][value] + parts[2][value] + parts[3][value];
  return parts[0];
}

}  // namespace handcast::landmarks
