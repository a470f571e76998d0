// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/nearest_pixel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "renderer/base/clones.hpp"
#include "renderer/base/load_eight.hpp"

namespace handcast::renderer::cpu {
namespace {

constexpr int kBlock = 32;  ///< pixels of a row that are scanned at once
/// Distance to the seed of a column without one in reach. Its square is out of reach too.
constexpr std::uint8_t kNoRow = 100;
/// Squared distance outside the area. Its sum with the square of the reach fits into 16 bits.
constexpr std::int16_t kFar = 16'000;

/// The distances of a row to the nearest seed at or before it, from those of the row before.
HANDCAST_CLONES void step_rows(const std::uint8_t* __restrict seeds, const std::uint8_t* before,
                               std::uint8_t* rows, int count) {
#pragma GCC ivdep
  for (int x = 0; x < count; ++x) {
    const auto next = static_cast<std::uint8_t>(before[x] + 1);
    const std::uint8_t bounded = next < kNoRow ? next : kNoRow;
    rows[x] = seeds[x] ? std::uint8_t{0} : bounded;
  }
}

/// Joins the distances upwards (in `to_seed`) and downwards to one signed offset; upwards if equal.
HANDCAST_CLONES void join_rows(const std::uint8_t* __restrict below,
                               std::int8_t* __restrict to_seed, int count) {
  for (int x = 0; x < count; ++x) {
    const auto up = static_cast<std::uint8_t>(to_seed[x]);
    to_seed[x] = static_cast<std::int8_t>(below[x] < up ? below[x] : -up);
  }
}

HANDCAST_CLONES void square_row(const std::int8_t* __restrict to_seed,
                                std::int16_t* __restrict squares, int count) {
  for (int x = 0; x < count; ++x) squares[x] = static_cast<std::int16_t>(to_seed[x] * to_seed[x]);
}

/// The first pixel that is set; `count` if none is.
int first_set(const std::uint8_t* pixels, int count) {
  int x = 0;
  const auto any_of_32 = [&] {
    return load_eight(pixels + x) | load_eight(pixels + x + 8) | load_eight(pixels + x + 16) |
           load_eight(pixels + x + 24);
  };
  while (x + 32 <= count && any_of_32() == 0) x += 32;
  while (x + 8 <= count && load_eight(pixels + x) == 0) x += 8;
  while (x < count && pixels[x] == 0) ++x;
  return x;
}

/// One past the last pixel that is set. At least one must be.
int end_of_set(const std::uint8_t* pixels, int count) {
  int x = count;
  while (x >= 8 && load_eight(pixels + x - 8) == 0) x -= 8;
  while (pixels[x - 1] == 0) --x;
  return x;
}

HANDCAST_CLONES bool any_set(const std::uint8_t* pixels, int count) {
  std::uint8_t any = 0;
  for (int x = 0; x < count; ++x) any |= pixels[x];
  return any != 0;
}

/// Bounds of the set pixels; empty if none is set.
Rect bounds_of(View<const std::uint8_t> set) {
  Rect bounds{set.width, set.height, 0, 0};
  for (int y = 0; y < set.height; ++y) {
    const std::uint8_t* row = set.row(y);
    if (!any_set(row, set.width)) continue;
    bounds.y0 = std::min(bounds.y0, y);
    bounds.y1 = y + 1;
    bounds.x0 = std::min(bounds.x0, first_set(row, set.width));
    bounds.x1 = std::max(bounds.x1, end_of_set(row, set.width));
  }
  return bounds;
}

constexpr int whole_vectors(int count) { return (count + 63) / 64 * 64; }
/// Beside a row of squares: whoever searches at its ends reads them.
constexpr std::size_t kMargins = 2 * NearestPixel::kLargestReach + kBlock;

struct Block {
  alignas(64) std::array<std::int16_t, kBlock> best;   ///< squared distance of the nearest seed
  alignas(64) std::array<std::int16_t, kBlock> shift;  ///< columns from the pixel to that seed
};

/// Searches left and right of all pixels of a block, one column farther at a time, until no wanted
/// pixel can get a nearer seed.
HANDCAST_CLONES void scan_block(const std::int16_t* __restrict squares,
                                const std::uint8_t* __restrict wanted, int reach, Block& block) {
  alignas(64) std::int16_t best[kBlock], shift[kBlock], needed[kBlock];
  for (int i = 0; i < kBlock; ++i) {
    best[i] = squares[i];
    shift[i] = 0;
    needed[i] = wanted[i] ? -1 : 0;
  }
  for (int d = 1; d <= reach; ++d) {
    const auto square = static_cast<std::int16_t>(d * d);
    const auto step = static_cast<std::int16_t>(d);
    std::int16_t farthest = 0;
    for (int i = 0; i < kBlock; ++i) {
      const auto left = static_cast<std::int16_t>(squares[i - d] + square);
      const auto right = static_cast<std::int16_t>(squares[i + d] + square);
      std::int16_t nearest = best[i], towards = shift[i];
      towards = left < nearest ? static_cast<std::int16_t>(-step) : towards;
      nearest = left < nearest ? left : nearest;
      towards = right < nearest ? step : towards;
      nearest = right < nearest ? right : nearest;
      best[i] = nearest;
      shift[i] = towards;
      const auto open = static_cast<std::int16_t>(nearest & needed[i]);
      farthest = open > farthest ? open : farthest;
    }
    if (farthest <= (d + 1) * (d + 1)) break;
  }
  std::copy(best, best + kBlock, block.best.begin());
  std::copy(shift, shift + kBlock, block.shift.begin());
}

/// Makes the wanted pixels with a seed within the limit 1 and all others 0.
HANDCAST_CLONES void keep_within(const Block& block, int limit, std::uint8_t* __restrict wanted) {
  const auto most = static_cast<std::int16_t>(limit);
  for (int i = 0; i < kBlock; ++i)
    wanted[i] = static_cast<std::uint8_t>((wanted[i] != 0) & (block.best[i] <= most));
}

}  // namespace

void NearestPixel::sweep_columns(View<const std::uint8_t> seeds, Rect area) {
  const int count = area.width();
  area_ = area;
  to_seed_stride_ = whole_vectors(count);
  to_seed_.resize(static_cast<std::size_t>(to_seed_stride_) * area.height());
  rows_below_.assign(count, kNoRow);
  const auto line = [&](int y) {
    return to_seed_.data() + static_cast<std::ptrdiff_t>(y - area.y0) * to_seed_stride_;
  };
  const std::uint8_t* above = rows_below_.data();
  for (int y = area.y0; y < area.y1; ++y) {
    auto* rows = reinterpret_cast<std::uint8_t*>(line(y));
    step_rows(seeds.row(y) + area.x0, above, rows, count);
    above = rows;
  }
  for (int y = area.y1 - 1; y >= area.y0; --y) {
    step_rows(seeds.row(y) + area.x0, rows_below_.data(), rows_below_.data(), count);
    join_rows(rows_below_.data(), line(y), count);
  }
}

NearestPixel::NearestPixel(int width, int height) {
  to_seed_.reserve(static_cast<std::size_t>(whole_vectors(width)) * height);
  rows_below_.reserve(static_cast<std::size_t>(width));
  squares_.reserve(static_cast<std::size_t>(width) + kMargins);
  row_.reserve(static_cast<std::size_t>(width) + kBlock);
}

void NearestPixel::start(View<const std::uint8_t> seeds, View<const std::uint8_t> wanted,
                         Rect bounds, int reach_px) {
  reach_px_ = std::clamp(reach_px, 0, kLargestReach);
  wanted_ = wanted;
  wanted_area_ = bounds;
  sweep_columns(seeds, wanted_area_.grown(reach_px_).within(wanted.width, wanted.height));
  squares_.assign(static_cast<std::size_t>(area_.width()) + kMargins, kFar);
  row_.resize(static_cast<std::size_t>(wanted_area_.width()) + kBlock);
}

std::span<const NearestSeed> NearestPixel::of_row(int y) {
  const std::uint8_t* const wanted = wanted_.row(y);
  const auto next = [&](int x) { return x + first_set(wanted + x, wanted_area_.x1 - x); };
  const int first = next(wanted_area_.x0);
  if (first == wanted_area_.x1) return {};
  const std::int8_t* to_seed =
      to_seed_.data() + static_cast<std::ptrdiff_t>(y - area_.y0) * to_seed_stride_;
  std::int16_t* squares = squares_.data() + kLargestReach;
  square_row(to_seed, squares, area_.width());
  const int limit = reach_px_ * reach_px_;
  Block block;
  NearestSeed* out = row_.data();
  for (int x = first; x < wanted_area_.x1; x = next(std::min(x + kBlock, wanted_area_.x1))) {
    alignas(64) std::array<std::uint8_t, kBlock> here{};
    std::memcpy(here.data(), wanted + x, std::min(kBlock, wanted_area_.x1 - x));
    scan_block(squares + (x - area_.x0), here.data(), reach_px_, block);
    keep_within(block, limit, here.data());
    for (int eight = 0; eight < kBlock; eight += 8)
      for (std::uint64_t left = load_eight(here.data() + eight); left != 0; left &= left - 1) {
        const int i = eight + std::countr_zero(left) / 8;
        const int dx = block.shift[i];
        const std::int8_t dy = to_seed[x - area_.x0 + i + dx];
        *out++ = {static_cast<std::int16_t>(x + i), static_cast<std::int16_t>(y),
                  static_cast<std::int8_t>(dx), dy, block.best[i]};
      }
  }
  return std::span(row_.data(), out);
}

std::span<const NearestSeed> NearestPixel::find(View<const std::uint8_t> seeds,
                                                View<const std::uint8_t> wanted, int reach_px) {
  all_.clear();
  const Rect rows = bounds_of(wanted);
  if (rows.empty()) return {};
  start(seeds, wanted, rows, reach_px);
  for (int y = rows.y0; y < rows.y1; ++y) {
    const auto row = of_row(y);
    all_.insert(all_.end(), row.begin(), row.end());
  }
  return all_;
}

}  // namespace handcast::renderer::cpu
