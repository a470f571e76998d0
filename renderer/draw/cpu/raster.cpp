// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/raster.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "renderer/base/clones.hpp"
#include "renderer/draw/cpu/triangle_setup.hpp"

namespace handcast::renderer::cpu {
namespace {

/// `fresh` where the bits of `hit` are set. Conditional moves would become a jump over the stores
/// of blocks without a hit, which the processor cannot predict.
template <class T>
[[gnu::always_inline]] inline T chosen(std::uint32_t hit, T fresh, T old) {
  return std::bit_cast<T>((std::bit_cast<std::uint32_t>(fresh) & hit) |
                          (std::bit_cast<std::uint32_t>(old) & ~hit));
}

/// What a triangle shows at a pixel.
struct Fresh {
  float depth, s, t, light;
};

/// Writes lane `i` of a block if it is covered (`outside` >= 0) and nearest.
[[gnu::always_inline]] inline void write_lane(PixelBlock& block, int i, std::int32_t outside,
                                              const Fresh& fresh, std::uint32_t tag) {
  const float depth = block.depth[i], s = block.s[i], t = block.t[i];
  const std::uint32_t old_tag = block.tag[i];
  tag |= static_cast<std::uint32_t>(static_cast<std::int32_t>(fresh.light)) << 8;
  const std::uint32_t hit = ((outside >= 0) & (fresh.depth <= depth)) ? ~0u : 0;
  block.depth[i] = chosen(hit, fresh.depth, depth);
  block.s[i] = chosen(hit, fresh.s, s);
  block.t[i] = chosen(hit, fresh.t, t);
  block.tag[i] = chosen(hit, tag, old_tag);
}

/// The columns and rows of pixels from the first one of a window, by column and row of blocks, then
/// lane.
struct Places {
  alignas(64) float right[kColumns][kLanes], down[kBandRows][kLanes];
};
constexpr Places places() {
  Places places{};
  for (int i = 0; i < kLanes; ++i) {
    for (int c = 0; c < kColumns; ++c)
      places.right[c][i] = static_cast<float>(c * kBlockSide + i % kBlockSide);
    for (int r = 0; r < kBandRows; ++r)
      places.down[r][i] = static_cast<float>(r * kBlockSide + (i >> kBlockBits));
  }
  return places;
}

/// A number that changes evenly from pixel to pixel.
struct Ramp {
  float first, dx, dy;

  [[gnu::always_inline]] float at(float right, float down) const {
    return first + dy * down + dx * right;
  }
  [[gnu::always_inline]] std::uint32_t bits_at(float right, float down) const {
    return std::bit_cast<std::uint32_t>(at(right, down));
  }
};

/// Draws triangle `i`, which must not be delicate, window by window.
template <bool kLit>
[[gnu::always_inline]] inline void fill_windows(const Setups& s, int i, RasterTarget& target) {
  static constexpr Places kPlaces = places();
  const auto value = [&](int k) { return Ramp{s.start[k][i], s.dx[k][i], s.dy[k][i]}; };
  const auto edge = [&](int k) {
    return Ramp{static_cast<float>(s.edge[k][i]), static_cast<float>(s.edge_dx[k][i]),
                static_cast<float>(s.edge_dy[k][i])};
  };
  const Ramp edge0 = edge(0), edge1 = edge(1), edge2 = edge(2);
  const Ramp depth = value(0), to_s = value(1), to_t = value(2), light = value(3);
  const std::uint32_t tag = s.tag[i];
  const int first_row = s.first_row[i], rows = s.last_row[i] + 1 - first_row,
            columns = s.last_column[i] + 1 - s.first_column[i];
  std::uint32_t covered = s.blocks[i];
  for (int first = 0;;) {
    PixelBlock* const blocks = target.row(first_row) + s.first_column[i] + first;
    const auto shift = static_cast<float>(first * kBlockSide);
    for (; covered != 0; covered &= covered - 1) {
      const int bit = std::countr_zero(covered);
      PixelBlock& block = blocks[bit / kColumns * target.columns() + bit % kColumns];
      const float *const right = kPlaces.right[bit % kColumns], *const down =
                                                                    kPlaces.down[bit / kColumns];
#pragma GCC ivdep
#pragma GCC unroll 1
      for (int lane = 0; lane < kLanes; ++lane) {
        const float x = right[lane] + shift, y = down[lane];
        const std::uint32_t outside =
            edge0.bits_at(x, y) | edge1.bits_at(x, y) | edge2.bits_at(x, y);
        write_lane(block, lane, static_cast<std::int32_t>(outside),
                   {depth.at(x, y), to_s.at(x, y), to_t.at(x, y), kLit ? light.at(x, y) : 255.f},
                   tag);
      }
    }
    first += kColumns;
    if (first >= columns) break;
    covered = window_of(columns - first, rows);  // all: they are few
  }
}

/// Value k of the corners of triangle `i`, the least and the largest.
struct Limits {
  float least, most;

  Limits(const Corners& of, int k, int i, float scale, float offset) {
    const auto [low, high] = std::minmax({of.value[0][k][i], of.value[1][k][i], of.value[2][k][i]});
    least = low * scale + offset;
    most = high * scale + offset;
  }
  float bounded(float value) const {
    const float raised = value > least ? value : least;
    return raised < most ? raised : most;
  }
};

/// An edge value at the first pixel of a block, narrowed to 32 bits such that all lanes keep their
/// sign: lanes differ by at most 2 * 3 * 16 * 960,000 < 2^27.
std::int32_t narrowed(double edge) {
  constexpr double kLimit = 1 << 30;
  return static_cast<std::int32_t>(std::clamp(edge, -kLimit, kLimit));
}

/// Draws any triangle.
void fill_with_care(const Setups& s, const Corners& corners, int i, const TexelMap& map,
                    RasterTarget& target) {
  const Limits of_s(corners, 1, i, map.scale.x, map.offset.x),
      of_t(corners, 2, i, map.scale.y, map.offset.y), of_light(corners, 3, i, 1, 0);
  for (int row = s.first_row[i]; row <= s.last_row[i]; ++row)
    for (int column = s.first_column[i]; column <= s.last_column[i]; ++column) {
      const int right = (column - s.first_column[i]) * kBlockSide,
                down = (row - s.first_row[i]) * kBlockSide;
      std::array<std::int32_t, 3> edge;
      for (int k = 0; k < 3; ++k)
        edge[k] = narrowed(s.edge[k][i] + double{1} * s.edge_dx[k][i] * right +
                           double{1} * s.edge_dy[k][i] * down);
      for (int lane = 0; lane < kLanes; ++lane) {
        const int x = lane % kBlockSide, y = lane / kBlockSide;
        std::int32_t outside = 0;
        for (int k = 0; k < 3; ++k) outside |= edge[k] + s.edge_dx[k][i] * x + s.edge_dy[k][i] * y;
        const auto value = [&](int k) {
          return s.start[k][i] + s.dx[k][i] * static_cast<float>(right + x) +
                 s.dy[k][i] * static_cast<float>(down + y);
        };
        write_lane(
            target.row(row)[column], lane, outside,
            {value(0), of_s.bounded(value(1)), of_t.bounded(value(2)), of_light.bounded(value(3))},
            s.tag[i]);
      }
    }
}

void clear(PixelBlock& block) {
  std::fill_n(block.depth, kLanes, std::numeric_limits<float>::infinity());
  std::fill_n(block.tag, kLanes, 0);
}

/// True if the triangle has an area and is turned to the side that is drawn.
bool is_drawn(const TriangleList& list, std::size_t triangle) {
  const std::int64_t area = list.doubled_areas[triangle];
  return area != 0 && !(list.facing == Facing::positive && area < 0) &&
         !(list.facing == Facing::negative && area > 0);
}

}  // namespace

Facing facing_of(std::span<const Corner> corners, std::span<const TriangleIndices> triangles,
                 std::vector<std::int64_t>& doubled_areas) {
  doubled_areas.resize(triangles.size());
  double volume = 0;
  std::int64_t sum = 0, sum_of_sizes = 0;
  const float depth_origin = corners.empty() ? 0 : corners.front().depth;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Corner &a = corners[triangles[t][0]], &b = corners[triangles[t][1]],
                 &c = corners[triangles[t][2]];
    const std::int64_t area =
        std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{c.x - a.x} * (b.y - a.y);
    doubled_areas[t] = area;
    sum += area;
    sum_of_sizes += std::abs(area);
    volume += static_cast<double>(area) * (a.depth + b.depth + c.depth - 3 * depth_origin);
  }
  if (2 * std::abs(sum) >= sum_of_sizes || volume == 0)
    return Facing::both;  // not closed: the areas of a closed surface cancel out
  return volume < 0 ? Facing::positive : Facing::negative;
}

RasterTarget::RasterTarget(int width, int height)
    : columns_(width / kBlockSide + 1),
      blocks_(static_cast<std::size_t>(columns_) * (height / kBlockSide + 1)),
      drawn_(2 * static_cast<std::size_t>(height / kBlockSide + 1)) {
  std::ranges::for_each(blocks_, clear);
}

void RasterTarget::start(int first) {
  for (int y = first_; y < first_ + static_cast<int>(rows()); ++y)
    for (const Span span : all_drawn(y))
      for (int x = span.x0; x < span.x1; ++x) clear(row(y)[x]);
  std::ranges::fill(drawn_, Span{});
  first_ = first;
  hand_ = 0;
}

void TriangleBins::reserve(std::size_t triangles) {
  constexpr std::size_t kMostBands = 30'000 / kBand;  // see snapped()
  bands_.reserve(triangles);
  first_.reserve(kMostBands + 2);
  triangles_.reserve(2 * triangles);
}

void TriangleBins::sort(const TriangleList& list, Rect region) {
  const int last_band = (region.y1 - 1) / kBand;
  first_.assign(static_cast<std::size_t>(last_band) + 2, 0);
  bands_.resize(list.triangles.size());
  for (std::size_t t = 0; t < list.triangles.size(); ++t) {
    bands_[t] = {};
    if (!is_drawn(list, t)) continue;
    const auto& [a, b, c] = list.triangles[t];
    const auto [top, bottom] =
        std::minmax({list.corners[a].y, list.corners[b].y, list.corners[c].y});
    const int y0 = std::max((top + kSubpixels - 1) >> 4, region.y0),
              y1 = std::min((bottom >> 4) + 1, region.y1);
    if (y0 >= y1) continue;
    bands_[t] = {static_cast<std::uint16_t>(y0 / kBand),
                 static_cast<std::uint16_t>((y1 - 1) / kBand + 1)};
    for (int band = bands_[t].first; band < bands_[t].end; ++band) ++first_[band];
  }
  std::exclusive_scan(first_.begin(), first_.end(), first_.begin(), 0u);
  triangles_.resize(first_.back());
  // Counts up to the begin of the next band, so that the bands move up by one.
  for (std::uint32_t t = 0; t < bands_.size(); ++t)
    for (int band = bands_[t].first; band < bands_[t].end; ++band) triangles_[first_[band]++] = t;
  std::rotate(first_.begin(), first_.end() - 1, first_.end());
  first_.front() = 0;
}

HANDCAST_CLONES void rasterise(const TriangleList& list, std::span<const std::uint32_t> triangles,
                               Rect region, RasterTarget& target) {
  Corners corners;
  Setups s;
  while (!triangles.empty()) {
    const auto some = triangles.first(std::min<std::size_t>(kAtOnce, triangles.size()));
    triangles = triangles.subspan(some.size());
    set_up(list, some, region, corners, s);
    for (int i = 0; i < static_cast<int>(some.size()); ++i) {
      const Span columns{s.first_column[i], s.last_column[i] + 1};
      for (int row = s.first_row[i]; row <= s.last_row[i]; ++row)
        target.drawn(row) = target.drawn(row).joined(columns);
      if (s.is_delicate[i])
        fill_with_care(s, corners, i, list.levels[level_of(shade_of_tag(s.tag[i]))], target);
      else
        list.is_lit ? fill_windows<true>(s, i, target) : fill_windows<false>(s, i, target);
    }
  }
}

}  // namespace handcast::renderer::cpu
