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
  float depth, s, t, light;

  [[gnu::always_inline]] Values operator+(const Values& o) const {
    return {depth + o.depth, s + o.s, t + o.t, light + o.light};
  }
  [[gnu::always_inline]] Values operator-(const Values& o) const {
    return {depth - o.depth, s - o.s, t - o.t, light - o.light};
  }
  [[gnu::always_inline]] Values operator*(float factor) const {
    return {depth * factor, s * factor, t * factor, light * factor};
  }
};

[[gnu::always_inline]] inline Values smaller(const Values& a, const Values& b) {
  return {std::min(a.depth, b.depth), std::min(a.s, b.s), std::min(a.t, b.t),
          std::min(a.light, b.light)};
}
[[gnu::always_inline]] inline Values larger(const Values& a, const Values& b) {
  return {std::max(a.depth, b.depth), std::max(a.s, b.s), std::max(a.t, b.t),
          std::max(a.light, b.light)};
}

/// A triangle prepared for a walk from block to block. An edge value is >= 0 at the pixels on its
/// inner side.
struct Setup {
  int first_column, last_column, first_row, last_row;  ///< of blocks
  std::array<std::int64_t, 3> edge;                    ///< at the first pixel of the first block
  std::array<std::int32_t, 3> edge_dx, edge_dy;        ///< change per pixel
  Values start, dx, dy;                                ///< at the same pixel; change per pixel
  Values least, most;                                  ///< of the corners
  std::uint32_t tag;                                   ///< of a pixel without light
};

/// Pixels exactly on a top or left edge belong to the triangle; those on other edges do not.
inline bool is_top_left(std::int32_t dx, std::int32_t dy) { return dy < 0 || (dy == 0 && dx > 0); }

[[gnu::always_inline]] inline Values values_of(const Corner& c, const TexelMap& map) {
  return {c.depth, c.u * map.scale.x + map.offset.x, c.v * map.scale.y + map.offset.y, c.light};
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
                                              std::int64_t doubled_area, const TexelMap& map,
                                              Setup& s) {
  const float scale = kSubpixels / static_cast<float>(doubled_area);
  const Values at_a = values_of(a, map), at_b = values_of(b, map), at_c = values_of(c, map),
               to_b = (at_b - at_a) * scale, to_c = (at_c - at_a) * scale;
  s.dx = to_b * static_cast<float>(c.y - a.y) + to_c * static_cast<float>(a.y - b.y);
  s.dy = to_b * static_cast<float>(a.x - c.x) + to_c * static_cast<float>(b.x - a.x);
  const float x =
      static_cast<float>(s.first_column * kBlockSide) - static_cast<float>(a.x) / kSubpixels;
  const float y =
      static_cast<float>(s.first_row * kBlockSide) - static_cast<float>(a.y) / kSubpixels;
  s.start = at_a + s.dx * x + s.dy * y;
  s.start.light += 0.5f;  // rounds when it is truncated
  s.least = smaller(at_a, smaller(at_b, at_c));
  s.most = larger(at_a, larger(at_b, at_c));
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
  const int last = static_cast<int>(list.levels.size()) - 1;
  return static_cast<std::uint32_t>(std::clamp(exponent >> 1, 0, last));
}

/// An edge value at the first pixel of a block, narrowed to 32 bits such that all lanes keep their
/// sign: lanes differ by at most 2 * 3 * 16 * 960,000 < 2^27.
template <bool kDelicate>
[[gnu::always_inline]] inline std::int32_t narrowed(std::int64_t edge) {
  constexpr std::int64_t kLimit = 1 << 30;
  if constexpr (kDelicate) edge = std::clamp(edge, -kLimit, kLimit);
  return static_cast<std::int32_t>(edge);
}

/// The difference of lane i of a block from the first pixel.
struct LaneSteps {
  alignas(64) std::int32_t edge[3][kLanes];
  alignas(64) float depth[kLanes], s[kLanes], t[kLanes], light[kLanes];
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
    steps.s[i] = s.dx.s * right + s.dy.s * down;
    steps.t[i] = s.dx.t * right + s.dy.t * down;
    steps.light[i] = s.dx.light * right + s.dy.light * down;
  }
}

/// `fresh` where the bits of `hit` are set. Conditional moves would become a jump over the stores
/// of blocks without a hit, which the processor cannot predict.
template <class T>
[[gnu::always_inline]] inline T chosen(std::uint32_t hit, T fresh, T old) {
  return std::bit_cast<T>((std::bit_cast<std::uint32_t>(fresh) & hit) |
                          (std::bit_cast<std::uint32_t>(old) & ~hit));
}

[[gnu::always_inline]] inline float bounded(float value, float least, float most) {
  const float raised = value > least ? value : least;
  return raised < most ? raised : most;
}

/// Tests the pixels of a block and writes those that are covered and nearest. `edge` and `at` are
/// the values at its first pixel. kDelicate: see is_delicate().
template <bool kDelicate, bool kLit>
[[gnu::always_inline]] inline void write_block(PixelBlock& block,
                                               const std::array<std::int32_t, 3> edge,
                                               const Values at, const LaneSteps& steps,
                                               const Setup& setup) {
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const std::int32_t outside =
        (edge[0] + steps.edge[0][i]) | (edge[1] + steps.edge[1][i]) | (edge[2] + steps.edge[2][i]);
    const float old_depth = block.depth[i], old_s = block.s[i], old_t = block.t[i];
    const std::uint32_t old_tag = block.tag[i];
    const float depth = at.depth + steps.depth[i];
    float s = at.s + steps.s[i], t = at.t + steps.t[i],
          light = kLit ? at.light + steps.light[i] : 255.f;
    if constexpr (kDelicate) {
      s = bounded(s, setup.least.s, setup.most.s);
      t = bounded(t, setup.least.t, setup.most.t);
      light = bounded(light, setup.least.light, setup.most.light);
    }
    const auto tag = static_cast<std::uint32_t>(static_cast<std::int32_t>(light)) << 8 | setup.tag;
    const std::uint32_t hit = ((outside >= 0) & (depth <= old_depth)) ? ~0u : 0;
    block.depth[i] = chosen(hit, depth, old_depth);
    block.s[i] = chosen(hit, s, old_s);
    block.t[i] = chosen(hit, t, old_t);
    block.tag[i] = chosen(hit, tag, old_tag);
  }
}

template <bool kDelicate, bool kLit>
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
      write_block<kDelicate, kLit>(blocks[column],
                                   {narrowed<kDelicate>(edge[0]), narrowed<kDelicate>(edge[1]),
                                    narrowed<kDelicate>(edge[2])},
                                   at, steps, s);
      at = at + right;
      for (int k = 0; k < 3; ++k) edge[k] += std::int64_t{s.edge_dx[k]} * kBlockSide;
    }
    row_start = row_start + down;
    for (int k = 0; k < 3; ++k) row_edge[k] += std::int64_t{s.edge_dy[k]} * kBlockSide;
  }
}

/// True if an edge value within the bounds of the triangle may not fit into 32 bits, or if rounding
/// may take an interpolated value out of the range of the corners by more than the border of a
/// picture makes up for: edges longer than 900 px, or so long and thin that the sum of the steps
/// over the bounds, in which values grow as length / height, is off by 1/8000 of the range.
[[gnu::always_inline]] inline bool is_delicate(const Setup& s, std::int64_t doubled_area) {
  constexpr std::int64_t kPixel = kSubpixels * kSubpixels, kLongest = 900 * kPixel,
                         kMost = 4096 * kPixel * kPixel;  // of length^2 / height
  std::int64_t longest = 0;
  for (int k = 0; k < 3; ++k)
    longest = std::max<std::int64_t>({longest, std::abs(s.edge_dx[k]), std::abs(s.edge_dy[k])});
  return longest > kLongest || longest * longest * longest > kMost * doubled_area;
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
      drawn_(static_cast<std::size_t>(height / kBlockSide + 1)) {
  std::ranges::for_each(blocks_, clear);
}

void RasterTarget::start(int first) {
  for (int y = first_; y < first_ + static_cast<int>(drawn_.size()); ++y) {
    for (int x = drawn(y).x0; x < drawn(y).x1; ++x) clear(row(y)[x]);
    drawn(y) = {};
  }
  first_ = first;
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
    const std::uint32_t level = level_of(a, b, c, std::abs(area), list);
    set_values(a, b, c, std::abs(area), list.levels[level], s);
    s.tag = tag_of(list.ids[corner[0]], shade_of(0, level));
    if (is_delicate(s, std::abs(area)))
      fill_blocks<true, true>(s, target);
    else
      list.is_lit ? fill_blocks<false, true>(s, target) : fill_blocks<false, false>(s, target);
  }
}

}  // namespace handcast::renderer::cpu
