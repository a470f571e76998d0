// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "renderer/draw/cpu/raster.hpp"

/// @file
/// Prepares triangles for the rasteriser, sixteen at once. All of it is inlined into a function
/// that is compiled for several instruction sets.

namespace handcast::renderer::cpu {

constexpr int kSubpixels = 16;
constexpr int kValues = 4;   ///< that are interpolated: depth, s, t and light
constexpr int kAtOnce = 16;  ///< triangles that are set up at once
template <class T>
using Each = T[kAtOnce];

/// A window is as many columns of blocks as the bits of a word can tell apart.
constexpr int kColumns = 32 / kBandRows, kWindow = kColumns * kBandRows;

/// The corners of some triangles, clockwise.
struct Corners {
  alignas(64) Each<std::int32_t> x[3], y[3];
  alignas(64) Each<float> value[3][kValues];  ///< with u and v for s and t
  alignas(64) Each<float> area;               ///< doubled

  Corners() : x{}, y{}, value{} { std::fill_n(area, kAtOnce, 1.f); }
};

/// Triangles prepared for a walk from block to block. An edge value is >= 0 at the pixels on its
/// inner side.
struct Setups {
  alignas(64) Each<std::int32_t> first_column, last_column, first_row, last_row;  ///< of blocks
  alignas(64) Each<double> edge[3];                       ///< at the first pixel of the first block
  alignas(64) Each<std::int32_t> edge_dx[3], edge_dy[3];  ///< change per pixel
  alignas(64) Each<float> start[kValues], dx[kValues], dy[kValues];  ///< the same of the values
  alignas(64) Each<std::uint32_t> tag;                               ///< of a pixel without light
  alignas(64) Each<std::int32_t> is_delicate;                        ///< 0 or 1
  /// The blocks of the first window that may be covered: bit c + kColumns r for column c and row r.
  alignas(64) Each<std::uint32_t> blocks;
};

[[gnu::always_inline]] inline void gather(const TriangleList& list,
                                          std::span<const std::uint32_t> triangles, Corners& out) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::int64_t area = list.doubled_areas[triangles[i]];
    const auto& [first, second, third] = list.triangles[triangles[i]];
    const std::array at{first, area > 0 ? second : third, area > 0 ? third : second};
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& corner = list.corners[at[k]];
      out.x[k][i] = corner.x;
      out.y[k][i] = corner.y;
      out.value[k][0][i] = corner.depth;
      out.value[k][1][i] = corner.u;
      out.value[k][2][i] = corner.v;
      out.value[k][3][i] = corner.light;
    }
    out.area[i] = static_cast<float>(std::abs(area));
  }
}

/// Sets the blocks that the triangles touch. A triangle whose bounds contain no pixel centre of the
/// region is empty.
[[gnu::always_inline]] inline void set_bounds(const Corners& of, Rect region, Setups& s) {
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kAtOnce; ++i) {
    const auto first = [i](const Each<std::int32_t>* at) {
      return (std::min(std::min(at[0][i], at[1][i]), at[2][i]) + kSubpixels - 1) >> 4;
    };
    const auto last = [i](const Each<std::int32_t>* at) {
      return std::max(std::max(at[0][i], at[1][i]), at[2][i]) >> 4;
    };
    const int x0 = std::max(first(of.x), region.x0), x1 = std::min(last(of.x), region.x1 - 1),
              y0 = std::max(first(of.y), region.y0), y1 = std::min(last(of.y), region.y1 - 1);
    const bool is_empty = (x0 > x1) | (y0 > y1);
    s.first_column[i] = x0 >> kBlockBits;
    s.last_column[i] = is_empty ? s.first_column[i] - 1 : x1 >> kBlockBits;
    s.first_row[i] = y0 >> kBlockBits;
    s.last_row[i] = is_empty ? s.first_row[i] - 1 : y1 >> kBlockBits;
  }
}

/// Sets edge k. Pixels exactly on a top or left edge belong to the triangle; those on other edges
/// do not.
[[gnu::always_inline]] inline void set_edge(int k, const Corners& of, Setups& s) {
  constexpr int kPitch = kBlockSide * kSubpixels;
  const int next = (k + 1) % 3;
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kAtOnce; ++i) {
    const std::int32_t dx = of.x[next][i] - of.x[k][i], dy = of.y[next][i] - of.y[k][i],
                       x = s.first_column[i] * kPitch - of.x[k][i],
                       y = s.first_row[i] * kPitch - of.y[k][i];
    const std::int32_t is_outer = (dy > 0) | ((dy == 0) & (dx <= 0));
    s.edge[k][i] = double{1} * dx * y - double{1} * dy * x - is_outer;
    s.edge_dx[k][i] = -dy * kSubpixels;
    s.edge_dy[k][i] = dx * kSubpixels;
  }
}

/// Sets the level of the picture that has about one texel per pixel in each triangle: half the
/// binary logarithm of the texels per pixel, rounded.
[[gnu::always_inline]] inline void find_levels(const Corners& of, float texels, int last,
                                               Each<std::int32_t>& level) {
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kAtOnce; ++i) {
    const auto &a = of.value[0], &b = of.value[1], &c = of.value[2];
    const float cross =
        (b[1][i] - a[1][i]) * (c[2][i] - a[2][i]) - (c[1][i] - a[1][i]) * (b[2][i] - a[2][i]);
    const float ratio = std::abs(cross) * texels * (kSubpixels * kSubpixels) / of.area[i];
    const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(2 * ratio) >> 23) - 127;
    level[i] = std::min(std::max(exponent >> 1, 0), last);
  }
}

/// Sets value k: it is scale[i] times that of the corners, plus offset[i].
[[gnu::always_inline]] inline void set_value(int k, const Corners& of, const float* scale,
                                             const float* offset, float rounded, Setups& s) {
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kAtOnce; ++i) {
    const float at_a = of.value[0][k][i] * scale[i] + offset[i],
                at_b = of.value[1][k][i] * scale[i] + offset[i],
                at_c = of.value[2][k][i] * scale[i] + offset[i];
    const float per_area = kSubpixels / of.area[i];
    const float to_b = (at_b - at_a) * per_area, to_c = (at_c - at_a) * per_area;
    const auto step = [i](const Each<std::int32_t>* at, int to, int from) {
      return static_cast<float>(at[to][i] - at[from][i]);
    };
    const float dx = to_b * step(of.y, 2, 0) + to_c * step(of.y, 0, 1),
                dy = to_b * step(of.x, 0, 2) + to_c * step(of.x, 1, 0);
    const float x = static_cast<float>(s.first_column[i] * kBlockSide) -
                    static_cast<float>(of.x[0][i]) / kSubpixels,
                y = static_cast<float>(s.first_row[i] * kBlockSide) -
                    static_cast<float>(of.y[0][i]) / kSubpixels;
    s.start[k][i] = at_a + dx * x + dy * y + rounded;
    s.dx[k][i] = dx;
    s.dy[k][i] = dy;
  }
}

/// Finds the delicate triangles, of which edge values may not be exact in floats, or rounding may
/// take an interpolated value out of the range of the corners by more than the border of a picture
/// makes up for: edges longer than 100 px, or so long and thin that the sum of the steps over the
/// bounds, in which values grow as length / height, is off by 1/8000 of the range.
[[gnu::always_inline]] inline void find_delicate(const Corners& of, Setups& s) {
  constexpr float kPixel = kSubpixels * kSubpixels, kLongest = 100 * kPixel,
                  kMost = 4096 * kPixel * kPixel;  // of length^2 / height
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kAtOnce; ++i) {
    std::int32_t most = 0;
    for (int k = 0; k < 3; ++k)
      most = std::max(std::max(most, std::abs(s.edge_dx[k][i])), std::abs(s.edge_dy[k][i]));
    const auto longest = static_cast<float>(most);
    s.is_delicate[i] = (longest > kLongest) | (longest * longest * longest > kMost * of.area[i]);
  }
}

/// The blocks of a window of a size.
[[gnu::always_inline]] inline std::uint32_t window_of(int columns, int rows) {
  constexpr std::uint32_t kFirstColumn = ~0u / ((1u << kColumns) - 1);
  const std::uint32_t row = (1u << std::min(columns, kColumns)) - 1,
                      all = ~0u >> (kWindow - kColumns * std::max(rows, 1));
  return rows > 0 ? kFirstColumn * row & all : 0;
}

/// Sets the blocks of the first window that are not outside of an edge.
[[gnu::always_inline]] inline void find_blocks(Setups& s) {
  using Ints = std::int32_t __attribute__((vector_size(4 * kAtOnce)));
  Ints most[3], right[3], down[3];  // the largest value of the edge in a block, and its steps
  int rows = 0;
  for (int i = 0; i < kAtOnce; ++i)
    rows = s.is_delicate[i] ? rows : std::max(rows, s.last_row[i] + 1 - s.first_row[i]);
  for (int k = 0; k < 3; ++k) {
    alignas(64) Each<std::int32_t> edge;
#pragma GCC unroll 1
    for (int i = 0; i < kAtOnce; ++i)
      edge[i] = static_cast<std::int32_t>(s.is_delicate[i] ? 0 : s.edge[k][i]);
    std::memcpy(&most[k], edge, sizeof edge);
    std::memcpy(&right[k], s.edge_dx[k], sizeof right[k]);
    std::memcpy(&down[k], s.edge_dy[k], sizeof down[k]);
    most[k] += (kBlockSide - 1) * ((right[k] > 0 ? right[k] : 0) + (down[k] > 0 ? down[k] : 0));
    right[k] *= kBlockSide;
    down[k] *= kBlockSide;
  }
  Ints inside{};
  for (int row = 0; row < rows; ++row) {
    Ints at0 = most[0], at1 = most[1], at2 = most[2];
    for (int column = 0; column < kColumns; ++column) {
      inside |=
          ((at0 | at1 | at2) >= 0) & static_cast<std::int32_t>(1u << (kColumns * row + column));
      at0 += right[0];
      at1 += right[1];
      at2 += right[2];
    }
    for (int k = 0; k < 3; ++k) most[k] += down[k];
  }
  std::memcpy(s.blocks, &inside, sizeof s.blocks);
#pragma GCC unroll 1
  for (int i = 0; i < kAtOnce; ++i)
    s.blocks[i] &=
        window_of(s.last_column[i] + 1 - s.first_column[i], s.last_row[i] + 1 - s.first_row[i]);
}

/// Prepares up to kAtOnce triangles.
[[gnu::always_inline]] inline void set_up(const TriangleList& list,
                                          std::span<const std::uint32_t> triangles, Rect region,
                                          Corners& corners, Setups& s) {
  gather(list, triangles, corners);
  set_bounds(corners, region, s);
  for (int k = 0; k < 3; ++k) set_edge(k, corners, s);
  find_delicate(corners, s);
  find_blocks(s);
  alignas(64) Each<std::int32_t> level;
  alignas(64) Each<float> one, none{}, scale_x, scale_y, offset_x, offset_y;
  find_levels(corners, list.texels, static_cast<int>(list.levels.size()) - 1, level);
  std::fill_n(one, kAtOnce, 1.f);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const TexelMap& map = list.levels[static_cast<std::size_t>(level[i])];
    scale_x[i] = map.scale.x;
    scale_y[i] = map.scale.y;
    offset_x[i] = map.offset.x;
    offset_y[i] = map.offset.y;
    s.tag[i] = tag_of(list.ids[list.triangles[triangles[i]][0]],
                      shade_of(0, static_cast<std::uint32_t>(level[i])));
  }
  set_value(0, corners, one, none, 0, s);
  set_value(1, corners, scale_x, offset_x, 0, s);
  set_value(2, corners, scale_y, offset_y, 0, s);
  set_value(3, corners, one, none, 0.5f, s);  // truncated later
}

}  // namespace handcast::renderer::cpu
