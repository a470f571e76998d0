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
  alignas(64) std::uint8_t light[kLanes];
};

[[gnu::always_inline]] inline bool any_hit(const PixelBlock& block) {
  int hits = 0;
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) hits |= block.depth[i] < kNothing;
  return hits != 0;
}

[[gnu::always_inline]] inline void set_surface(const PixelBlock& block, Coloured& out) {
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const std::uint32_t level = light_of_tag(block.tag[i]);
    out.surface[i] =
        static_cast<SurfaceId>(block.depth[i] < kNothing ? id_of_tag(block.tag[i]) : 0);
    out.light[i] = static_cast<std::uint8_t>(level - (level >> 8));
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
template <bool kFirst>
[[gnu::always_inline]] inline void set_colour(const PixelBlock& block, const Sampler sampler,
                                              std::uint32_t hand, Coloured& out) {
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    const bool hit = (block.depth[i] < kNothing) & (kFirst || id_of_tag(block.tag[i]) / 64 == hand);
    const std::int32_t index =
        sampler.index(block.u[i], block.v[i]) & -static_cast<std::int32_t>(hit);
    const std::uint32_t lit = dimmed(sampler.texels[index], light_of_tag(block.tag[i])) | kOpaque;
    const std::uint32_t old = kFirst ? 0 : out.colour[i];
    out.colour[i] = hit ? lit : old;
  }
}

/// The position of a pixel in the planes of a frame.
struct Place {
  std::uint32_t* colour;
  glm::vec2* uv;
  SurfaceId* surface;
  std::uint8_t* light;
};

[[gnu::always_inline]] inline void copy_pixels(const Coloured& from, int lane, int count,
                                               const Place to) {
  std::memcpy(to.colour, from.colour + lane, count * sizeof(std::uint32_t));
  std::memcpy(static_cast<void*>(to.uv), from.uv + lane, count * sizeof(glm::vec2));
  std::memcpy(to.surface, from.surface + lane, count);
  std::memcpy(to.light, from.light + lane, count);
}

/// The part of a block within the region.
struct Clip {
  int x0, x1, y0, y1;

  bool whole() const { return x1 - x0 == kBlockSide; }
};

[[gnu::always_inline]] inline void copy_block(const Coloured& from, const Clip clip,
                                              FrameBuffer& frame) {
  for (int y = clip.y0; y < clip.y1; ++y) {
    const int lane = y % kBlockSide * kBlockSide + clip.x0 % kBlockSide;
    const Place to{frame.colour.row(y) + clip.x0, frame.uv.row(y) + clip.x0,
                   frame.surface.row(y) + clip.x0, frame.light.row(y) + clip.x0};
    clip.whole() ? copy_pixels(from, lane, kBlockSide, to)
                 : copy_pixels(from, lane, clip.x1 - clip.x0, to);
  }
}

[[gnu::always_inline]] inline void darken_block(const Clip clip, FrameBuffer& frame) {
  for (int y = clip.y0; y < clip.y1; ++y) {
    const int count = clip.whole() ? kBlockSide : clip.x1 - clip.x0;
    std::fill_n(frame.colour.row(y) + clip.x0, count, 0);
    std::fill_n(frame.surface.row(y) + clip.x0, count, SurfaceId{0});
  }
}

/// Blocks [columns.x0, columns.x1) of one row, clipped by the region.
HANDCAST_CLONES void colour_blocks(const PixelBlock* blocks, Span columns, int block_row,
                                   Rect region, std::span<const Sampler> samplers,
                                   FrameBuffer& frame) {
  const int y0 = std::max(block_row * kBlockSide, region.y0),
            y1 = std::min((block_row + 1) * kBlockSide, region.y1);
  Coloured out;
  for (int column = columns.x0; column < columns.x1; ++column) {
    const PixelBlock& block = blocks[column];
    const Clip clip{std::max(column * kBlockSide, region.x0),
                    std::min((column + 1) * kBlockSide, region.x1), y0, y1};
    if (!any_hit(block)) {
      darken_block(clip, frame);
      continue;
    }
    set_surface(block, out);
    set_colour<true>(block, samplers[0], 0, out);
    for (std::size_t hand = 1; hand < samplers.size(); ++hand)
      set_colour<false>(block, samplers[hand], static_cast<std::uint32_t>(hand), out);
    copy_block(out, clip, frame);
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

void Drawer::rasterise_hand(const DrawnHand& hand, int index, Rect region, RasterTarget& target) {
  corners_.resize(hand.mesh->vertex_count());
  ids_.resize(hand.mesh->vertex_count());
  set_corners(hand, index, corners_, ids_);
  const Facing facing = facing_of(corners_, hand.mesh->triangles, areas_);
  rasterise({corners_, hand.mesh->triangles, areas_, ids_, facing}, region, target);
}

void Drawer::draw(std::span<const DrawnHand> hands, Rect region, RasterTarget& target,
                  FrameBuffer& out) {
  target.clear();
  samplers_.clear();
  for (std::size_t i = 0; i < hands.size(); ++i) {
    rasterise_hand(hands[i], static_cast<int>(i), region, target);
    samplers_.emplace_back(hands[i].texture);
  }
  for (int row = region.y0 / kBlockSide; row * kBlockSide < region.y1; ++row) {
    const Span columns = target.drawn(row),
               pixels = Span{columns.x0 * kBlockSide, columns.x1 * kBlockSide}.within(region.x0,
                                                                                      region.x1);
    for (int y = std::max(row * kBlockSide, region.y0);
         y < std::min((row + 1) * kBlockSide, region.y1); ++y) {
      out.darken(y, region.x0, region.x1, pixels);
    }
    if (!columns.empty()) colour_blocks(target.row(row), columns, row, region, samplers_, out);
  }
}

}  // namespace handcast::renderer::cpu
