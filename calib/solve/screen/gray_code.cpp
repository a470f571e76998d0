// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/gray_code.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "ipc/base/statistics.hpp"

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

double pattern_misfit(const GreyView& white, const GreyView& black, const GreyView& pattern,
                      const GreyView& inverse) {
  constexpr int kLeastContrast = 16;
  constexpr double kPercentile = 0.7;
  struct Lit {
    int contrast, off;
  };
  std::vector<Lit> lit;
  for (int y = 0; y < white.height_px; ++y) {
    const auto *w = white.pixels + y * white.stride, *b = black.pixels + y * black.stride,
               *p = pattern.pixels + y * pattern.stride, *i = inverse.pixels + y * inverse.stride;
    for (int x = 0; x < white.width_px; ++x)
      if (const int contrast = w[x] - b[x]; contrast >= kLeastContrast)
        lit.push_back({contrast, std::abs(p[x] + i[x] - w[x] - b[x])});
  }
  if (lit.empty()) return 0;
  // The brighter half: noise is large where little light is.
  const auto half = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
  std::ranges::nth_element(lit, half, {}, &Lit::contrast);
  std::vector<double> misfits;
  for (auto pixel = half; pixel != lit.end(); ++pixel)
    misfits.push_back(pixel->off / static_cast<double>(pixel->contrast));
  return quantile(std::move(misfits), kPercentile);
}

}  // namespace handcast::calib
