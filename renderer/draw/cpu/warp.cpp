// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include "renderer/base/clones.hpp"
#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer::cpu {
namespace {

constexpr std::int32_t kNowhere = -1;

/// Sets `places` to the index in the source of each pixel of a block, or kNowhere. Returns true if
/// one has a source.
HANDCAST_CLONES bool find_sources(const PixelBlock& block, std::int32_t stride, Rect from,
                                  std::int32_t* __restrict places) {
  std::int32_t last = kNowhere;
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    // NOLINTBEGIN(bugprone-incorrect-roundings): lround is no vector instruction
    const auto x = static_cast<std::int32_t>(block.s[i] + 0.5f),
               y = static_cast<std::int32_t>(block.t[i] + 0.5f);
    // NOLINTEND(bugprone-incorrect-roundings)
    const bool inside = (block.depth[i] < std::numeric_limits<float>::infinity()) & (x >= from.x0) &
                        (x < from.x1) & (y >= from.y0) & (y < from.y1);
    places[i] = inside ? y * stride + x : kNowhere;
    last = std::max(last, places[i]);
  }
  return last != kNowhere;
}

/// Copies the pixels of one block whose sources are lit.
void fetch(const std::array<std::int32_t, kLanes>& places, int column, int row, Rect region,
           const FrameBuffer& in, FrameBuffer& out) {
  for (int i = 0; i < kLanes; ++i) {
    const int x = column * kBlockSide + i % kBlockSide, y = row * kBlockSide + i / kBlockSide;
    const std::int32_t place = places[i];
    if (place == kNowhere || x < region.x0 || x >= region.x1 || y < region.y0 || y >= region.y1)
      continue;
    const SurfaceId surface = in.surface.row(0)[place];
    if (surface == 0) continue;
    out.surface.row(y)[x] = surface;
    out.colour.row(y)[x] = in.colour.row(0)[place];
    out.place.row(y)[x] = in.place.row(0)[place];
    out.shade.row(y)[x] = in.shade.row(0)[place];
    out.lit[y] = out.lit[y].joined({x, x + 1});
  }
}

void fetch_band(RasterTarget& target, Rect from, Rect band, const FrameBuffer& in,
                FrameBuffer& out) {
  std::array<std::int32_t, kLanes> places;
  for (int row = band.y0 / kBlockSide; row * kBlockSide < band.y1; ++row)
    for (int column = target.drawn(row).x0; column < target.drawn(row).x1; ++column)
      if (find_sources(target.row(row)[column], in.colour.stride(), from, places.data()))
        fetch(places, column, row, band, in, out);
}

}  // namespace

Warper::Warper() {
  constexpr std::size_t kTriangles = 2 * 16'384;
  cells_.corners.reserve(kTriangles);
  cells_.triangles.reserve(kTriangles);
  bins_.reserve(kTriangles);
  areas_.reserve(kTriangles);
  ids_.reserve(kTriangles);
}

void Warper::warp(const WarpGrid& grid, Rect from, Rect region, const FrameBuffer& in,
                  RasterTarget& target, FrameBuffer& out) {
  cells_.set(grid, from);
  facing_of(cells_.corners, cells_.triangles, areas_);
  ids_.assign(cells_.corners.size(), 1);
  static constexpr TexelMap kItself;
  const TriangleList cells{.corners = cells_.corners,
                           .triangles = cells_.triangles,
                           .doubled_areas = areas_,
                           .ids = ids_,
                           .levels = {&kItself, 1},
                           .is_lit = false};
  bins_.sort(cells, region);
  for (int y = region.y0; y < region.y1; ++y) out.darken(y, region.x0, region.x1, {});
  for (int band = region.y0 / kBand; band * kBand < region.y1; ++band) {
    const Rect part = Rect{region.x0, band * kBand, region.x1, (band + 1) * kBand}.overlap(region);
    target.start(band * kBandRows);
    rasterise(cells, bins_.of_band(band), part, target);
    fetch_band(target, from, part, in, out);
  }
}

}  // namespace handcast::renderer::cpu
