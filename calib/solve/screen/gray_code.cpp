// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/gray_code.hpp"

#include <algorithm>
#include <bit>

namespace handcast::calib {
namespace {

int highest_bit(int size_px) { return std::bit_width(static_cast<unsigned>(size_px - 1)) - 1; }

std::uint8_t shade(int coordinate_px, int bit) {
  const int gray = coordinate_px ^ (coordinate_px >> 1);
  return (gray >> bit) & 1 ? 255 : 0;
}

}  // namespace

/// The stripes of bit n of a Gray code are 2^(n+1) px wide.
GrayCode::GrayCode(int width_px, int height_px, int finest_px)
    : width_px_(width_px),
      height_px_(height_px),
      lowest_bit_(std::bit_width(static_cast<unsigned>(finest_px)) - 2) {
  const int columns = highest_bit(width_px), rows = highest_bit(height_px);
  for (int bit = std::max(columns, rows); bit >= lowest_bit_; --bit) {
    if (bit <= columns) bits_.push_back({false, bit});
    if (bit <= rows) bits_.push_back({true, bit});
  }
}

void GrayCode::draw(int index, std::uint8_t* pixels) const {
  const int pixel_count = width_px_ * height_px_;
  if (index < 2) {
    std::fill_n(pixels, pixel_count, static_cast<std::uint8_t>(index == 0 ? 255 : 0));
    return;
  }
  const auto bit = bits_[static_cast<std::size_t>(index / 2 - 1)];
  const std::uint8_t inverse = index % 2 ? 255 : 0;
  for (int y = 0; y < height_px_; ++y)
    for (int x = 0; x < width_px_; ++x) *pixels++ = shade(bit.of_row ? y : x, bit.number) ^ inverse;
}

}  // namespace handcast::calib
