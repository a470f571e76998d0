// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/deinterleave.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

namespace handcast::camera::leap {
namespace {

/// 1 in the weights of rows.
constexpr int kOne = 256;

/// Every second byte, from the first or the second on.
void take(const std::uint8_t* both, std::size_t eye, std::uint8_t* out, int count) {
  static_assert(std::endian::native == std::endian::little);
  const int shift = eye == 0 ? 0 : 8;
  for (int x = 0; x < count; ++x) {
    std::uint16_t pair = 0;
    std::memcpy(&pair, both + 2 * static_cast<std::ptrdiff_t>(x), sizeof pair);
    out[x] = static_cast<std::uint8_t>(pair >> shift);
  }
}

/// In 16 bits, which vector units multiply at once.
void mix(const std::uint8_t* above, const std::uint8_t* below, int share_below, std::uint8_t* out,
         int count) {
  const auto lower = static_cast<std::uint16_t>(share_below),
             upper = static_cast<std::uint16_t>(kOne - share_below);
  for (int x = 0; x < count; ++x) {
    const auto sum = static_cast<std::uint16_t>(above[x] * upper + below[x] * lower + kOne / 2);
    out[x] = static_cast<std::uint8_t>(sum / kOne);
  }
}

}  // namespace

void deinterleave(std::span<const std::uint8_t> both, std::size_t eye, int width_px,
                  std::span<std::uint8_t> image) {
  const auto width = static_cast<std::size_t>(width_px);
  const int rows = static_cast<int>(both.size() / 2 / width),
            rows_out = static_cast<int>(image.size() / width), copies = rows_out / rows;
  if (copies == 1) return take(both.data(), eye, image.data(), static_cast<int>(image.size()));
  std::vector<std::uint8_t> above(width), below(width);
  const auto read = [&](int y, std::vector<std::uint8_t>& row) {
    take(both.data() + 2 * width * static_cast<std::size_t>(std::min(y, rows - 1)), eye, row.data(),
         width_px);
  };
  read(0, above);
  read(1, below);
  for (int y = 0, row = 0; y < rows_out; ++y) {
    // The middle of the row in those of the sensor: (y + 1/2) / copies - 1/2.
    const int place = std::clamp((2 * y + 1 - copies) * kOne / (2 * copies), 0, (rows - 1) * kOne);
    if (place / kOne > row) {
      std::swap(above, below);
      read(++row + 1, below);
    }
    mix(above.data(), below.data(), place % kOne,
        image.data() + width * static_cast<std::size_t>(y), width_px);
  }
}

}  // namespace handcast::camera::leap
