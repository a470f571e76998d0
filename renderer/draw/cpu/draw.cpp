// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>

#include "renderer/base/clones.hpp"
#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer::cpu {
namespace {

/// Blocks that are coloured together. What one step writes pixel by pixel is read as a vector by
/// the next: by then it is in the cache.
constexpr int kBatch = 16;

/// Blocks of one row that show something, with their colours.
struct Batch {
  int count = 0;
  std::array<std::int32_t, kBatch> column;
  std::array<const PixelBlock*, kBatch> block;
  std::array<std::uint32_t, kBatch> hands;  ///< that the block shows, as bits
  std::array<Lookup, kBatch> at;
  struct alignas(64) Colours {
    std::uint32_t rgba[kLanes];
  };
  std::array<Colours, kBatch> colour;
};

/// The hands that a block shows, as bits.
[[gnu::always_inline]] inline std::uint32_t hands_in(const PixelBlock& block) {
  std::uint32_t hands = 0;
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i)
    hands |= block.tag[i] != 0 ? 1u << id_of_tag(block.tag[i]) / 64 : 0u;
  return hands;
}

[[gnu::always_inline]] inline bool shows(std::uint32_t tag, std::uint32_t hand) {
  return (tag != 0) & (id_of_tag(tag) / 64 == hand);
}

/// Lanes that do not show the hand look up texel 0.
[[gnu::always_inline]] inline void find_places(const PixelBlock& block, std::int32_t stride,
                                               std::int32_t fraction, std::uint32_t hand,
                                               Lookup& at) {
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    at.set(i, block.s[i], block.t[i], stride, fraction);
    at.index[i] &= -static_cast<std::int32_t>(shows(block.tag[i], hand));
  }
}

/// The same for a hand with texture coordinates that may be outside of the picture.
void find_bounded_places(const PixelBlock& block, const Sampler& sampler, std::uint32_t hand,
                         Lookup& at) {
  for (int i = 0; i < kLanes; ++i) {
    const std::uint32_t tag = block.tag[i];
    if (shows(tag, hand)) {
      const glm::vec2 place =
          sampler.maps()[level_of(shade_of_tag(tag))].within({block.s[i], block.t[i]});
      at.set(i, place.x, place.y, sampler.stride, sampler.fraction);
    } else {
      at.index[i] = 0;
    }
  }
}

/// Adds the colours of the pixels that show one hand. The first one makes all others dark.
[[gnu::always_inline]] inline void set_colours(const PixelBlock& block, const Lookup& at,
                                               std::uint32_t hand, bool is_first,
                                               std::uint32_t* __restrict colour) {
  alignas(64) float factor[kLanes];
  alignas(64) std::uint32_t fresh[kLanes];
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i)
    factor[i] =
        static_cast<float>(static_cast<std::int32_t>(block.tag[i] >> 8 & 0xff)) * (1 / 255.f);
  mix(at, factor, fresh);
  const std::uint32_t kept = is_first ? 0 : ~0u;
#pragma GCC ivdep
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i)
    colour[i] = shows(block.tag[i], hand) ? fresh[i] | kOpaque : colour[i] & kept;
}

/// Colours what a batch shows of one hand.
[[gnu::always_inline]] inline void colour_hand(const Sampler& sampler, std::uint32_t hand,
                                               Batch& batch) {
  static_assert(Lookup::kCount == kLanes);
  const std::uint32_t* const texels = sampler.texels;
  const std::int32_t stride = sampler.stride, fraction = sampler.fraction;
  for (int b = 0; b < batch.count; ++b) {
    if ((batch.hands[b] >> hand & 1) == 0) continue;
    sampler.leaves_picture ? find_bounded_places(*batch.block[b], sampler, hand, batch.at[b])
                           : find_places(*batch.block[b], stride, fraction, hand, batch.at[b]);
  }
  for (int b = 0; b < batch.count; ++b) {
    if ((batch.hands[b] >> hand & 1) == 0) continue;
    Lookup& at = batch.at[b];
#pragma GCC unroll 16
    for (int i = 0; i < kLanes; ++i) at.read(i, texels, stride);
  }
  const std::uint32_t before = (1u << hand) - 1;
  for (int b = 0; b < batch.count; ++b)
    if (batch.hands[b] >> hand & 1)
      set_colours(*batch.block[b], batch.at[b], hand, (batch.hands[b] & before) == 0,
                  batch.colour[b].rgba);
}

/// The rows of a frame that a row of blocks covers.
struct Rows {
  std::uint32_t* colour[kBlockSide];
  glm::vec2* place[kBlockSide];
  SurfaceId* surface[kBlockSide];
  std::uint16_t* shade[kBlockSide];

  Rows(FrameBuffer& frame, int y0, int y1) {
    for (int i = 0; i < kBlockSide; ++i) {
      const int y = std::clamp(y0 / kBlockSide * kBlockSide + i, y0, y1 - 1);
      colour[i] = frame.colour.row(y);
      place[i] = frame.place.row(y);
      surface[i] = frame.surface.row(y);
      shade[i] = frame.shade.row(y);
    }
  }
};

/// The part of a block within the region.
struct Clip {
  int x0, x1, y0, y1;

  bool whole() const { return (x1 - x0) * (y1 - y0) == kLanes; }
};

/// What a frame keeps of a block, in the order of its lanes.
struct Drawn {
  alignas(64) glm::vec2 place[kLanes];
  alignas(64) SurfaceId surface[kLanes];
  alignas(64) std::uint16_t shade[kLanes];
};

[[gnu::always_inline]] inline void set_drawn(const PixelBlock& block, Drawn& out) {
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    out.surface[i] = static_cast<SurfaceId>(id_of_tag(block.tag[i]));
    out.shade[i] = shade_of_tag(block.tag[i]);
  }
  float* const place = &out.place[0].x;
#pragma GCC unroll 1
  for (int i = 0; i < kLanes; ++i) {
    place[2 * i] = block.s[i];
    place[2 * i + 1] = block.t[i];
  }
}

/// Copies pixels [x, x + count) of one line of a block, from lane `lane` on.
[[gnu::always_inline]] inline void copy_pixels(const std::uint32_t* colour, const Drawn& drawn,
                                               int lane, int count, const Rows& to, int line,
                                               int x) {
  std::memcpy(to.colour[line] + x, colour + lane, count * sizeof(std::uint32_t));
  std::memcpy(static_cast<void*>(to.place[line] + x), drawn.place + lane,
              count * sizeof(glm::vec2));
  std::memcpy(to.surface[line] + x, drawn.surface + lane, count);
  std::memcpy(to.shade[line] + x, drawn.shade + lane, count * sizeof(std::uint16_t));
}

[[gnu::always_inline]] inline void copy_block(const std::uint32_t* colour, const PixelBlock& block,
                                              const Clip clip, const Rows& rows) {
  Drawn drawn;
  set_drawn(block, drawn);
  if (clip.whole()) {
#pragma GCC unroll 4
    for (int line = 0; line < kBlockSide; ++line)
      copy_pixels(colour, drawn, line * kBlockSide, kBlockSide, rows, line, clip.x0);
    return;
  }
  for (int y = clip.y0; y < clip.y1; ++y) {
    const int line = y % kBlockSide;
    copy_pixels(colour, drawn, line * kBlockSide + clip.x0 % kBlockSide, clip.x1 - clip.x0, rows,
                line, clip.x0);
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
  const auto clip_of = [&](int column) {
    return Clip{std::max(column * kBlockSide, region.x0),
                std::min((column + 1) * kBlockSide, region.x1), y0, y1};
  };
  Batch batch;
  for (int column = columns.x0; column < columns.x1;) {
    batch.count = 0;
    for (; column < columns.x1 && batch.count < kBatch; ++column) {
      const std::uint32_t hands = hands_in(blocks[column]);
      if (hands == 0) {
        darken_block(clip_of(column), rows);
        continue;
      }
      batch.column[batch.count] = column;
      batch.block[batch.count] = blocks + column;
      batch.hands[batch.count++] = hands;
    }
    for (std::uint32_t hand = 0; hand < samplers.size(); ++hand)
      colour_hand(samplers[hand], hand, batch);
    for (int b = 0; b < batch.count; ++b)
      copy_block(batch.colour[b].rgba, *batch.block[b], clip_of(batch.column[b]), rows);
  }
}

/// Fills the corners and the surface ids of a hand, per vertex.
HANDCAST_CLONES void set_corners(const DrawnHand& hand, int index, std::span<Corner> corners,
                                 std::span<std::uint8_t> ids) {
  const bool shaded = !hand.light.empty();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::vec2 at = hand.position_px[i], uv = hand.mesh->uv[i];
    const float light = shaded ? 255 * std::clamp(hand.light[i], 0.f, 1.f) : 255;
    corners[i] = {snapped(at.x), snapped(at.y), hand.depth_m[i], uv.x, uv.y, light};
    ids[i] = surface_id(index, hand.mesh->chart[i]);
  }
}

void colour_band(Rect band, std::span<const Sampler> samplers, RasterTarget& target,
                 FrameBuffer& out) {
  for (int row = band.y0 / kBlockSide; row * kBlockSide < band.y1; ++row) {
    const auto [left, right] = target.all_drawn(row);
    const Span all = left.joined(right),
               pixels = Span{all.x0 * kBlockSide, all.x1 * kBlockSide}.within(band.x0, band.x1);
    for (int y = std::max(row * kBlockSide, band.y0); y < std::min((row + 1) * kBlockSide, band.y1);
         ++y) {
      out.darken(y, band.x0, band.x1, pixels);
      if (!right.empty()) out.clear(y, left.x1 * kBlockSide, right.x0 * kBlockSide);
    }
    for (const Span columns : {left, right})
      if (!columns.empty()) colour_blocks(target.row(row), columns, row, band, samplers, out);
  }
}

}  // namespace

Drawer::Drawer() {
  constexpr std::size_t kVertices = 4096, kTriangles = 2 * kVertices;
  for (Placed& placed : placed_) {
    placed.corners.reserve(kVertices);
    placed.ids.reserve(kVertices);
    placed.areas.reserve(kTriangles);
    placed.bins.reserve(kTriangles);
  }
}

void Drawer::place(const DrawnHand& hand, const Sampler& sampler, int index, Rect region) {
  Placed& placed = placed_[static_cast<std::size_t>(index)];
  placed.corners.resize(hand.mesh->vertex_count());
  placed.ids.resize(hand.mesh->vertex_count());
  set_corners(hand, index, placed.corners, placed.ids);
  const Facing facing = facing_of(placed.corners, hand.mesh->triangles, placed.areas);
  placed.list = {.corners = placed.corners,
                 .triangles = hand.mesh->triangles,
                 .doubled_areas = placed.areas,
                 .ids = placed.ids,
                 .facing = facing,
                 .levels = sampler.maps(),
                 .texels = sampler.size,
                 .is_lit = !hand.light.empty()};
  placed.bins.sort(placed.list, region);
}

void Drawer::draw(std::span<const DrawnHand> hands, std::span<const Sampler> samplers, Rect region,
                  Crew& crew, std::span<RasterTarget> targets, FrameBuffer& out) {
  crew.rouse();
  for (std::size_t i = 0; i < hands.size(); ++i)
    place(hands[i], samplers[i], static_cast<int>(i), region);
  const int first = region.y0 / kBand, last = (region.y1 - 1) / kBand;
  auto draw_band = [&](int part, int worker) {
    const int band = first + part;
    RasterTarget& target = targets[static_cast<std::size_t>(worker)];
    const Rect rows = Rect{region.x0, band * kBand, region.x1, (band + 1) * kBand}.overlap(region);
    target.start(band * kBandRows);
    for (std::size_t i = 0; i < hands.size(); ++i) {
      if (i > 0) target.begin_other();
      rasterise(placed_[i].list, placed_[i].bins.of_band(band), rows, target);
    }
    colour_band(rows, samplers, target, out);
  };
  crew.run(last - first + 1, draw_band);
}

}  // namespace handcast::renderer::cpu
