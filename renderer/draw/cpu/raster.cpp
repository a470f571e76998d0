// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/cpu/raster.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "renderer/base/clones.hpp"

namespace handcast::renderer::cpu {
namespace {

constexpr int kSubpixels = 16;

/// The values interpolated over a triangle, at a pixel, or their change from pixel to pixel.
struct Values {
  float depth, u, v, light;

  [[gnu::always_inline]] Values operator+(const Values& o) const {
    return {depth + o.depth, u + o.u, v + o.v, light + o.light};
  }
  [[gnu::always_inline]] Values operator-(const Values& o) const {
    return {depth - o.depth, u - o.u, v - o.v, light - o.light};
  }
  [[gnu::always_inline]] Values operator*(float s) const {
    return {depth * s, u * s, v * s, light * s};
  }
};

/// A triangle prepared for a walk from block to block. An edge value is >= 0 at the pixels on its
/// inner side.
struct Setup {
  int first_column, last_column, first_row, last_row;  ///< of blocks
  std::array<std::int64_t, 3> edge;                    ///< at the first pixel of the first block
  std::array<std::int32_t, 3> edge_dx, edge_dy;        ///< change per pixel
  Values start, dx, dy;                                ///< at the same pixel; change per pixel
  std::uint32_t id_level;  ///< the parts of the tag that are equal in the whole triangle
};

/// Pixels exactly on a top or left edge belong to the triangle; those on other edges do not.
inline bool is_top_left(std::int32_t dx, std::int32_t dy) { return dy < 0 || (dy == 0 && dx > 0); }

[[gnu::always_inline]] inline Values values_of(const Corner& c) {
  return {c.depth, c.u, c.v, c.light};
}

/// Sets the blocks that the triangle touches. Returns false if its bounds contain no pixel centre
/// of the region.
[[gnu::always_inline]] inline bool set_bounds(const Corner& a, const Corner& b, const Corner& c,
                                              Rect region, Setup& s) {
  const auto first = [](int p, int q, int r) {
    return (std::min({p, q, r}) + kSubpixels - 1) >> 4;
  };
  const auto last = [](int p, int q, int r) { return std::max({p, q, r}) >> 4; };
  const int x0 = std::max(first(a.x, b.x, c.x), region.x0),
            x1 = std::min(last(a.x, b.x, c.x), region.x1 - 1);
  const int y0 = std::max(first(a.y, b.y, c.y), region.y0),
            y1 = std::min(last(a.y, b.y, c.y), region.y1 - 1);
  s.first_column = x0 / kBlockSide;
  s.last_column = x1 / kBlockSide;
  s.first_row = y0 / kBlockSide;
  s.last_row = y1 / kBlockSide;
  return x0 <= x1 && y0 <= y1;
}

[[gnu::always_inline]] inline void set_edge(int k, const Corner& from, const Corner& to, Setup& s) {
  constexpr int kPitch = kBlockSide * kSubpixels;
  const std::int32_t dx = to.x - from.x, dy = to.y - from.y;
  const std::int64_t x = s.first_column * kPitch - from.x, y = s.first_row * kPitch - from.y;
  s.edge[k] = dx * y - dy * x - (is_top_left(dx, dy) ? 0 : 1);
  s.edge_dx[k] = -dy * kSubpixels;
  s.edge_dy[k] = dx * kSubpixels;
}

[[gnu::always_inline]] inline void set_values(const Corner& a, const Corner& b, const Corner& c,
                                              std::int64_t doubled_area, Setup& s) {
  const float scale = kSubpixels / static_cast<float>(doubled_area);
  const Values to_b = (values_of(b) - values_of(a)) * scale,
               to_c = (values_of(c) - values_of(a)) * scale;
  s.dx = to_b * static_cast<float>(c.y - a.y) + to_c * static_cast<float>(a.y - b.y);
  s.dy = to_b * static_cast<float>(a.x - c.x) + to_c * static_cast<float>(b.x - a.x);
  const float x =
      static_cast<float>(s.first_column * kBlockSide) - static_cast<float>(a.x) / kSubpixels;
  const float y =
      static_cast<float>(s.first_row * kBlockSide) - static_cast<float>(a.y) / kSubpixels;
  s.start = values_of(a) + s.dx * x + s.dy * y;
  s.start.light += 0.5f;  // rounds when it is truncated
}

/// The level of a picture that has about one texel per pixel in this triangle: half the binary
/// logarithm of the texels per pixel, rounded.
[[gnu::always_inline]] inline std::uint32_t level_of(const Corner& a, const Corner& b,
                                                     const Corner& c, std::int64_t doubled_area,
                                                     const TriangleList& list) {
  const float cross = (b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v);
  const float ratio =
      std::abs(cross) * list.texels * (kSubpixels * kSubpixels) / static_cast<float>(doubled_area);
  const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(2 * ratio) >> 23) - 127;
  return static_cast<std::uint32_t>(std::clamp(exponent >> 1, 0, list.last_level));
}

/// An edge value at the first pixel of a block, narrowed to 32 bits such that all lanes keep their
/// sign: lanes differ by at most 2 * 3 * 16 * 960,000 < 2^27.
template <bool kLarge>
[[gnu::always_inline]] inline std::int32_t narrowed(std::int64_t edge) {
  constexpr std::int64_t kLimit = 1 << 30;
  if constexpr (kLarge) edge = std::clamp(edge, -kLimit, kLimit);
  return static_cast<std::int32_t>(edge);
}

/// The difference of lane i of a block from the first pixel.
struct LaneSteps {
  alignas(64) std::int32_t edge[3][kLanes];
  alignas(64) float depth[kLanes], u[kLanes], v[kLanes], light[kLanes];
};

[[gnu::always_inline]] inline void set_steps(const Setup& s, LaneSteps& steps) {
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const int x = i % kBlockSide, y = i / kBlockSide;
    const auto right = static_cast<float>(x), down = static_cast<float>(y);
    steps.edge[0][i] = s.edge_dx[0] * x + s.edge_dy[0] * y;
    steps.edge[1][i] = s.edge_dx[1] * x + s.edge_dy[1] * y;
    steps.edge[2][i] = s.edge_dx[2] * x + s.edge_dy[2] * y;
    steps.depth[i] = s.dx.depth * right + s.dy.depth * down;
    steps.u[i] = s.dx.u * right + s.dy.u * down;
    steps.v[i] = s.dx.v * right + s.dy.v * down;
    steps.light[i] = s.dx.light * right + s.dy.light * down;
  }
}

/// Tests the pixels of a block and writes those that are covered and nearest. `edge` and `at` are
/// the values at its first pixel.
[[gnu::always_inline]] inline void write_block(PixelBlock& block,
                                               const std::array<std::int32_t, 3> edge,
                                               const Values at, const LaneSteps& steps,
                                               std::uint32_t id_level) {
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const std::int32_t outside =
        (edge[0] + steps.edge[0][i]) | (edge[1] + steps.edge[1][i]) | (edge[2] + steps.edge[2][i]);
    const float old_depth = block.depth[i], old_u = block.u[i], old_v = block.v[i];
    const std::uint32_t old_tag = block.tag[i];
    const float depth = at.depth + steps.depth[i];
    // In huge triangles rounding takes the light out of its range.
    const std::int32_t plane = static_cast<std::int32_t>(at.light + steps.light[i]),
                       raised = plane > 0 ? plane : 0;
    const auto light = static_cast<std::uint32_t>(raised < 256 ? raised : 256);
    const bool hit = (outside >= 0) & (depth <= old_depth);
    block.depth[i] = hit ? depth : old_depth;
    block.u[i] = hit ? at.u + steps.u[i] : old_u;
    block.v[i] = hit ? at.v + steps.v[i] : old_v;
    block.tag[i] = hit ? light << 8 | id_level : old_tag;
  }
}

template <bool kLarge>
[[gnu::always_inline]] inline void fill_blocks(const Setup& s, RasterTarget& target) {
  LaneSteps steps;
  set_steps(s, steps);
  const Values right = s.dx * kBlockSide, down = s.dy * kBlockSide;
  Values row_start = s.start;
  std::array<std::int64_t, 3> row_edge = s.edge;
  for (int row = s.first_row; row <= s.last_row; ++row) {
    target.drawn(row) = target.drawn(row).joined({s.first_column, s.last_column + 1});
    PixelBlock* const blocks = target.row(row);
    Values at = row_start;
    std::array<std::int64_t, 3> edge = row_edge;
    for (int column = s.first_column; column <= s.last_column; ++column) {
      write_block(blocks[column],
                  {narrowed<kLarge>(edge[0]), narrowed<kLarge>(edge[1]), narrowed<kLarge>(edge[2])},
                  at, steps, s.id_level);
      at = at + right;
      for (int k = 0; k < 3; ++k) edge[k] += std::int64_t{s.edge_dx[k]} * kBlockSide;
    }
    row_start = row_start + down;
    for (int k = 0; k < 3; ++k) row_edge[k] += std::int64_t{s.edge_dy[k]} * kBlockSide;
  }
}

/// Returns true if an edge value within the bounds of the triangle may not fit into 32 bits.
[[gnu::always_inline]] inline bool is_large(const Setup& s) {
  constexpr std::int32_t kLargest = 900 * kSubpixels * kSubpixels;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(s.edge_dx[k]) > kLargest || std::abs(s.edge_dy[k]) > kLargest) return true;
  }
  return false;
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
      drawn_(static_cast<std::size_t>(height / kBlockSide + 1)) {
  for (PixelBlock& block : blocks_)
    std::fill_n(block.depth, kLanes, std::numeric_limits<float>::infinity());
}

void RasterTarget::start(int first) {
  for (int y = first_; y < first_ + static_cast<int>(drawn_.size()); ++y) {
    for (int x = drawn(y).x0; x < drawn(y).x1; ++x)
      std::fill_n(row(y)[x].depth, kLanes, std::numeric_limits<float>::infinity());
    drawn(y) = {};
  }
  first_ = first;
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
  for (const std::uint32_t t : triangles) {
    const std::int64_t area = list.doubled_areas[t];
    const TriangleIndices& corner = list.triangles[t];
    const Corner& a = list.corners[corner[0]];
    const Corner& b = list.corners[corner[area > 0 ? 1 : 2]];
    const Corner& c = list.corners[corner[area > 0 ? 2 : 1]];
    Setup s;
    if (!set_bounds(a, b, c, region, s)) continue;
    set_edge(0, a, b, s);
    set_edge(1, b, c, s);
    set_edge(2, c, a, s);
    set_values(a, b, c, std::abs(area), s);
    s.id_level = list.ids[corner[0]] | level_of(a, b, c, std::abs(area), list) << 20;
    is_large(s) ? fill_blocks<true>(s, target) : fill_blocks<false>(s, target);
  }
}

}  // namespace handcast::renderer::cpu
