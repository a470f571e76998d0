// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <limits>

#include "renderer/base/clones.hpp"
#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer::cpu {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

/// A block with its colours.
struct Coloured {
  alignas(64) std::uint32_t colour[kLanes];
  alignas(64) glm::vec2 uv[kLanes];
  alignas(64) SurfaceId surface[kLanes];
  alignas(64) std::uint16_t shade[kLanes];
};

/// The hands that a block shows, as bits.
[[gnu::always_inline]] inline std::uint32_t hands_in(const PixelBlock& block) {
  std::uint32_t hands = 0;
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i)
    hands |= block.depth[i] < kNothing ? 1u << id_of_tag(block.tag[i]) / 64 : 0u;
  return hands;
}

[[gnu::always_inline]] inline void set_surface(const PixelBlock& block, Coloured& out) {
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const std::uint32_t light = light_of_tag(block.tag[i]);
    out.surface[i] =
        static_cast<SurfaceId>(block.depth[i] < kNothing ? id_of_tag(block.tag[i]) : 0);
    out.shade[i] = shade_of(light - (light >> 8), level_of_tag(block.tag[i]));
  }
  float* const uv = &out.uv[0].x;
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    uv[2 * i] = block.u[i];
    uv[2 * i + 1] = block.v[i];
  }
}

/// Colours the pixels that show one hand. With the first hand, all others become dark. Lanes
/// without light look up texel 0.
template <bool kFirst, bool kSmooth>
[[gnu::always_inline]] inline void set_colour(const PixelBlock& block, const Sampler sampler,
                                              std::uint32_t hand, Coloured& out) {
  static_assert(Lookup::kCount == kLanes);
  Lookup at;
  alignas(64) std::int32_t hits[kLanes];
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const bool hit = (block.depth[i] < kNothing) & (id_of_tag(block.tag[i]) / 64 == hand);
    const auto mask = -static_cast<std::int32_t>(hit);
    hits[i] = mask;
    if constexpr (kSmooth) {
      const auto level = static_cast<std::int32_t>(level_of_tag(block.tag[i]));
      const Footprint place = sampler.around(block.u[i], block.v[i], level & mask);
      at.index[i] = place.index & mask;
      at.right[i] = place.right;
      at.down[i] = place.down;
    } else {
      at.index[i] = sampler.nearest(block.u[i], block.v[i]) & mask;
    }
  }
  // The barriers keep the compiler from reading by gather instructions, which take longer than
  // single loads on most processors.
  asm volatile("" : "+m"(at));
#pragma GCC unroll 16
  for (int i = 0; i < kLanes; ++i) sampler.read<kSmooth>(at, i);
  asm volatile("" : "+m"(at));
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const std::uint32_t colour = kSmooth ? mean_of(at.upper[i], at.lower[i], at.place(i))
                                         : static_cast<std::uint32_t>(at.upper[i]);
    const std::uint32_t lit = dimmed(colour, light_of_tag(block.tag[i])) | kOpaque;
    const std::uint32_t old = kFirst ? 0 : out.colour[i];
    out.colour[i] = hits[i] != 0 ? lit : old;
  }
}

template <bool kFirst>
[[gnu::always_inline]] inline void add_hand(const PixelBlock& block, const Sampler& sampler,
                                            std::uint32_t hand, Coloured& out) {
  sampler.smooth ? set_colour<kFirst, true>(block, sampler, hand, out)
                 : set_colour<kFirst, false>(block, sampler, hand, out);
}

/// The rows of a frame that a row of blocks covers.
struct Rows {
  std::uint32_t* colour[kBlockSide];
  glm::vec2* uv[kBlockSide];
  SurfaceId* surface[kBlockSide];
  std::uint16_t* shade[kBlockSide];

  Rows(FrameBuffer& frame, int y0, int y1) {
    for (int i = 0; i < kBlockSide; ++i) {
      const int y = std::clamp(y0 / kBlockSide * kBlockSide + i, y0, y1 - 1);
      colour[i] = frame.colour.row(y);
      uv[i] = frame.uv.row(y);
      surface[i] = frame.surface.row(y);
      shade[i] = frame.shade.row(y);
    }
  }
};

/// Copies pixels [x, x + count) of one line of a block, from lane `lane` on.
[[gnu::always_inline]] inline void copy_pixels(const Coloured& from, int lane, int count,
                                               const Rows& to, int line, int x) {
  std::memcpy(to.colour[line] + x, from.colour + lane, count * sizeof(std::uint32_t));
  std::memcpy(static_cast<void*>(to.uv[line] + x), from.uv + lane, count * sizeof(glm::vec2));
  std::memcpy(to.surface[line] + x, from.surface + lane, count);
  std::memcpy(to.shade[line] + x, from.shade + lane, count * sizeof(std::uint16_t));
}

/// The part of a block within the region.
struct Clip {
  int x0, x1, y0, y1;

  bool whole() const { return (x1 - x0) * (y1 - y0) == kLanes; }
};

[[gnu::always_inline]] inline void copy_block(const Coloured& from, const Clip clip,
                                              const Rows& rows) {
  if (clip.whole()) {
#pragma GCC unroll 4
    for (int line = 0; line < kBlockSide; ++line)
      copy_pixels(from, line * kBlockSide, kBlockSide, rows, line, clip.x0);
    return;
  }
  for (int y = clip.y0; y < clip.y1; ++y) {
    const int line = y % kBlockSide;
    copy_pixels(from, line * kBlockSide + clip.x0 % kBlockSide, clip.x1 - clip.x0, rows, line,
                clip.x0);
  }
}

[[gnu::always_inline]] inline void darken_block(const Clip clip, const Rows& rows) {
  for (int y = clip.y0; y < clip.y1; ++y) {
    std::fill_n(rows.colour[y % kBlockSide] + clip.x0, clip.x1 - clip.x0, 0);
    std::fill_n(rows.surface[y % kBlockSide] + clip.x0, clip.x1 - clip.x0, SurfaceId{0});
  }
}

/// Blocks [columns.x0, columns.x1) of one row, clipped by the region.
HANDCAST_CLONES void colour_blocks(const PixelBlock* blocks, Span columns, int block_row,
                                   Rect region, std::span<const Sampler> samplers,
                                   FrameBuffer& frame) {
  const int y0 = std::max(block_row * kBlockSide, region.y0),
            y1 = std::min((block_row + 1) * kBlockSide, region.y1);
  const Rows rows(frame, y0, y1);
  Coloured out;
  for (int column = columns.x0; column < columns.x1; ++column) {
    const PixelBlock& block = blocks[column];
    const Clip clip{std::max(column * kBlockSide, region.x0),
                    std::min((column + 1) * kBlockSide, region.x1), y0, y1};
    const std::uint32_t hands = hands_in(block);
    if (hands == 0) {
      darken_block(clip, rows);
      continue;
    }
    set_surface(block, out);
    bool is_first = true;
    for (std::uint32_t hand = 0; hand < samplers.size(); ++hand) {
      if ((hands >> hand & 1) == 0) continue;
      is_first ? add_hand<true>(block, samplers[hand], hand, out)
               : add_hand<false>(block, samplers[hand], hand, out);
      is_first = false;
    }
    copy_block(out, clip, rows);
  }
}

/// Fills the corners and the surface ids of a hand, per vertex.
HANDCAST_CLONES void set_corners(const DrawnHand& hand, int index, std::span<Corner> corners,
                                 std::span<std::uint8_t> ids) {
  const bool shaded = !hand.light.empty();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::vec2 at = hand.position_px[i], uv = hand.mesh->uv[i];
    const float light = shaded ? 256 * std::clamp(hand.light[i], 0.f, 1.f) : 256;
    corners[i] = {snapped(at.x), snapped(at.y), hand.depth_m[i], uv.x, uv.y, light};
    ids[i] = surface_id(index, hand.mesh->chart[i]);
  }
}

}  // namespace

void Drawer::place(const DrawnHand& hand, int index, Rect region) {
  Placed& placed = placed_[static_cast<std::size_t>(index)];
  placed.corners.resize(hand.mesh->vertex_count());
  placed.ids.resize(hand.mesh->vertex_count());
  set_corners(hand, index, placed.corners, placed.ids);
  const Facing facing = facing_of(placed.corners, hand.mesh->triangles, placed.areas);
  const Sampler& sampler = samplers_.emplace_back(hand.texture);
  placed.list = {placed.corners, hand.mesh->triangles,           placed.areas,      placed.ids,
                 facing,         sampler.width * sampler.height, sampler.last_level};
  placed.bins.sort(placed.list, region);
}

void Drawer::colour_band(Rect band, RasterTarget& target, FrameBuffer& out) const {
  for (int row = band.y0 / kBlockSide; row * kBlockSide < band.y1; ++row) {
    const Span columns = target.drawn(row),
               pixels =
                   Span{columns.x0 * kBlockSide, columns.x1 * kBlockSide}.within(band.x0, band.x1);
    for (int y = std::max(row * kBlockSide, band.y0); y < std::min((row + 1) * kBlockSide, band.y1);
         ++y)
      out.darken(y, band.x0, band.x1, pixels);
    if (!columns.empty()) colour_blocks(target.row(row), columns, row, band, samplers_, out);
  }
}

void Drawer::draw(std::span<const DrawnHand> hands, Rect region, RasterTarget& target,
                  FrameBuffer& out) {
  samplers_.clear();
  placed_.resize(std::max(placed_.size(), hands.size()));
  for (std::size_t i = 0; i < hands.size(); ++i) place(hands[i], static_cast<int>(i), region);
  for (int band = region.y0 / kBand; band * kBand < region.y1; ++band) {
    const Rect part = Rect{region.x0, band * kBand, region.x1, (band + 1) * kBand}.overlap(region);
    target.start(band * kBandRows);
    for (std::size_t i = 0; i < hands.size(); ++i)
      rasterise(placed_[i].list, placed_[i].bins.of_band(band), part, target);
    colour_band(part, target, out);
  }
}

}  // namespace handcast::renderer::cpu
