// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/clones.hpp"
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
                          std::span<const Texture* const> textures, const FrameBuffer& frame) {
  table_.set_up(settings);
  std::vector<Sampler> samplers;
  for (const Texture* texture : textures) samplers.emplace_back(texture);
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
    const Sampler& sampler = samplers[surface / 64];
    const std::uint32_t* texel = sampler.texels + sampler.index(uv.x, uv.y);
    __builtin_prefetch(texel);
    const std::uint8_t light = frame.light.row(seed_y)[seed_x];
    const std::uint32_t factor = (light + (light >> 7)) * full >> 8,
                        alpha = std::max(1u, 255 * full >> 8);
    patches_.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), uv, texel,
                        static_cast<std::uint16_t>(factor), static_cast<std::uint8_t>(alpha),
                        surface, light});
  }
}

void Filler::apply_patches(FrameBuffer& frame) const {
  for (const Patch& patch : patches_) {
    frame.lit[patch.y] = frame.lit[patch.y].joined({patch.x, patch.x + 1});
    frame.colour.row(patch.y)[patch.x] =
        dimmed(*patch.texel, patch.factor) | std::uint32_t{patch.alpha} << 24;
    frame.uv.row(patch.y)[patch.x] = patch.uv;
    frame.surface.row(patch.y)[patch.x] = patch.surface;
    frame.light.row(patch.y)[patch.x] = patch.light;
  }
}

FillCounts Filler::fill(View<const std::uint8_t> mask, const config::Fill& settings, Rect region,
                        std::span<const Texture* const> textures, FrameBuffer& frame) {
  FillCounts counts = sort_pixels(mask, region, frame);
  if (counts.lit == 0 || counts.dark == 0) return counts;
  make_patches(settings, region, textures, frame);
  apply_patches(frame);
  counts.filled = static_cast<int>(patches_.size());
  counts.dark -= counts.filled;
  return counts;
}

}  // namespace handcast::renderer::cpu
