// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/clones.hpp"
#include "renderer/base/load_eight.hpp"
#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer::cpu {
namespace {

/// One row of the region: mask and drawing in, regions D (`lit`) and C (`unlit`) out.
struct Sorting {
  const std::uint8_t* mask;
  SurfaceId* surface;
  std::uint32_t* colour;
  std::uint8_t *lit, *unlit;
};

HANDCAST_CLONES int count_set(const std::uint8_t* pixels, int count) {
  int set = 0;
  for (int x = 0; x < count; ++x) set += pixels[x] & 1;
  return set;
}

/// Sorts the pixels [x0, x1) into the regions. Returns true if there is light outside the hand.
HANDCAST_CLONES bool sort_row(const Sorting row, int x0, int x1) {
  std::uint8_t spilt = 0;
#pragma GCC ivdep
  for (int x = x0; x < x1; ++x) {
    const auto hand = static_cast<std::uint8_t>(row.mask[x] ? 255 : 0),
               light = static_cast<std::uint8_t>(row.surface[x] ? 255 : 0);
    row.lit[x] = hand & light;
    row.unlit[x] = hand & ~light;
    spilt |= ~hand & light;
  }
  return spilt != 0;
}

/// Removes light outside the hand.
HANDCAST_CLONES void darken_spilt(const Sorting row, int x0, int x1) {
#pragma GCC ivdep
  for (int x = x0; x < x1; ++x) row.surface[x] &= row.lit[x];
#pragma GCC ivdep
  for (int x = x0; x < x1; ++x) row.colour[x] = row.lit[x] ? row.colour[x] : 0;
}

/// Gives the pixels [x0, x1) of a row that are hand in part the same part of their light.
void soften_row(const std::uint8_t* mask, std::uint32_t* colour, int x0, int x1) {
  static const ShareTable kTable = share_table();
  const auto soften = [&](int x) {
    if (mask[x] == 0 || mask[x] == 255 || colour[x] == 0) return;
    colour[x] = dimmed(colour[x], kTable[mask[x]]) | alpha_in_part(colour[x] >> 24, mask[x]) << 24;
  };
  int x = x0;
  for (; x + 8 <= x1; x += 8) {
    const std::uint64_t word = load_eight(mask + x);
    if (word == 0 || word == ~std::uint64_t{0}) continue;
    for (int i = 0; i < 8; ++i) soften(x + i);
  }
  for (; x < x1; ++x) soften(x);
}

/// The colours of all footprints of a lookup.
HANDCAST_CLONES void mix(const Lookup& at, std::uint32_t* __restrict colours) {
  for (int i = 0; i < Lookup::kCount; ++i)
    colours[i] = mean_of(at.upper[i], at.lower[i], at.place(i));
}

View<const std::uint8_t> part_of(const Plane<std::uint8_t>& plane, Rect region) {
  return {plane.row(region.y0) + region.x0, region.width(), region.height(), plane.stride()};
}

}  // namespace

FillCounts Filler::sort_pixels(View<const std::uint8_t> mask, Rect region, FrameBuffer& frame) {
  // Whole vectors if there is room: the two scratch planes may be written beside the region.
  constexpr int kVector = 64;
  const int x0 = region.x0 & -kVector,
            x1 = std::min((region.x1 + kVector - 1) & -kVector, mask.width);
  FillCounts counts;
  for (int y = region.y0; y < region.y1; ++y) {
    const Sorting row{mask.row(y), frame.surface.row(y), frame.colour.row(y), lit_.row(y),
                      unlit_.row(y)};
    const bool spilt = sort_row(row, x0, x1);
    const Span span = frame.lit[y].within(region.x0, region.x1);
    if (!span.empty()) {
      if (spilt) darken_spilt(row, span.x0, span.x1);
      counts.lit += count_set(row.lit + span.x0, span.x1 - span.x0);
    }
    counts.dark += count_set(row.unlit + region.x0, region.width());
  }
  return counts;
}

void Filler::make_patches(const config::Fill& settings, Rect region,
                          std::span<const MipChain* const> textures, const FrameBuffer& frame) {
  table_.set_up(settings);
  samplers_.clear();
  for (const MipChain* texture : textures) samplers_.emplace_back(texture);
  patches_.clear();
  for (const NearestSeed& seed :
       nearest_.find(part_of(lit_, region), part_of(unlit_, region), table_.reach_px)) {
    const std::uint32_t full = table_.strength[seed.squared_px];
    if (full == 0) continue;
    const int x = seed.x + region.x0, y = seed.y + region.y0;
    const int seed_x = x + seed.dx, seed_y = y + seed.dy;
    const int mirror_x = seed_x + seed.dx, mirror_y = seed_y + seed.dy;
    const SurfaceId surface = frame.surface.row(seed_y)[seed_x];
    glm::vec2 uv = frame.uv.row(seed_y)[seed_x];
    const bool inside = mirror_x >= region.x0 && mirror_x < region.x1 && mirror_y >= region.y0 &&
                        mirror_y < region.y1;
    if (inside && frame.surface.row(mirror_y)[mirror_x] == surface) {
      const glm::vec2 step = uv - frame.uv.row(mirror_y)[mirror_x];
      if (glm::dot(step, step) <= table_.squared_limit_uv[seed.squared_px]) uv += step;
    }
    const Sampler& sampler = samplers_[surface / 64];
    const std::uint16_t shade = frame.shade.row(seed_y)[seed_x];
    const Footprint place = sampler.smooth ? sampler.around(uv.x, uv.y, level_of(shade))
                                           : Footprint{sampler.nearest(uv.x, uv.y), 0, 0};
    __builtin_prefetch(sampler.texels + place.index);
    const std::uint32_t light = light_of(shade);
    patches_.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), uv, &sampler,
                        place, static_cast<std::uint16_t>((light + (light >> 7)) * full >> 8),
                        shade, surface, table_.alpha[seed.squared_px]});
  }
}

void Filler::apply_patches(FrameBuffer& frame) const {
  Lookup at{};
  std::array<std::uint32_t, Lookup::kCount> colours;
  for (std::size_t first = 0; first < patches_.size(); first += Lookup::kCount) {
    const auto some = std::span(patches_).subspan(
        first, std::min<std::size_t>(Lookup::kCount, patches_.size() - first));
    for (std::size_t i = 0; i < some.size(); ++i) {
      const Patch& patch = some[i];
      at.index[i] = patch.place.index;
      at.right[i] = patch.place.right;
      at.down[i] = patch.place.down;
      // A footprint without neighbours is that of the nearest texel.
      patch.sampler->read<true>(at, static_cast<int>(i));
    }
    mix(at, colours.data());
    for (std::size_t i = 0; i < some.size(); ++i) put(some[i], colours[i], frame);
  }
}

void Filler::put(const Patch& patch, std::uint32_t colour, FrameBuffer& frame) {
  frame.lit[patch.y] = frame.lit[patch.y].joined({patch.x, patch.x + 1});
  frame.colour.row(patch.y)[patch.x] = dimmed(colour, patch.factor) | std::uint32_t{patch.alpha}
                                                                          << 24;
  frame.uv.row(patch.y)[patch.x] = patch.uv;
  frame.surface.row(patch.y)[patch.x] = patch.surface;
  frame.shade.row(patch.y)[patch.x] = patch.shade;
}

FillCounts Filler::fill(View<const std::uint8_t> mask, const config::Fill& settings, Rect region,
                        std::span<const MipChain* const> textures, FrameBuffer& frame) {
  FillCounts counts = sort_pixels(mask, region, frame);
  if (counts.lit != 0 && counts.dark != 0) {
    make_patches(settings, region, textures, frame);
    apply_patches(frame);
    counts.filled = static_cast<int>(patches_.size());
    counts.dark -= counts.filled;
  }
  for (int y = region.y0; y < region.y1; ++y) {
    const Span span = frame.lit[y].within(region.x0, region.x1);
    if (!span.empty()) soften_row(mask.row(y), frame.colour.row(y), span.x0, span.x1);
  }
  return counts;
}

}  // namespace handcast::renderer::cpu
