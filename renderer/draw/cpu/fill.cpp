// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "renderer/base/clones.hpp"
#include "renderer/base/load_eight.hpp"
#include "renderer/draw/cpu/passes.hpp"

namespace handcast::renderer::cpu {
namespace {

/// One row of the region: mask and drawing in, regions D (what is left of `surface`) and C
/// (`unlit`) out.
struct Sorting {
  const std::uint8_t* mask;
  SurfaceId* surface;
  std::uint32_t* colour;
  std::uint8_t* unlit;
};

/// Red, green and blue of a colour times `factor` / 256 (0..256); alpha 0.
std::uint32_t dimmed(std::uint32_t colour, std::uint32_t factor) {
  const std::uint32_t red_blue = ((colour & 0xff00ff) * factor >> 8) & 0xff00ff;
  const std::uint32_t green = ((colour & 0x00ff00) * factor >> 8) & 0x00ff00;
  return red_blue | green;
}

constexpr int kVector = 64;  ///< pixels that are sorted at once

/// What a row holds, lane by lane. A sum stays below 256: a row is shorter than 256 vectors.
struct RowSums {
  alignas(64) std::uint8_t lit[kVector] = {}, unlit[kVector] = {}, spilt[kVector] = {};
};

/// Sorts `count` pixels from `x` on into the regions, and adds them to the sums but the first
/// `skipped`.
[[gnu::always_inline]] inline void sort_pixels(const Sorting& row, int x, int count, int skipped,
                                               RowSums& sums) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const auto hand = static_cast<std::uint8_t>(row.mask[x + i] ? 255 : 0),
               light = static_cast<std::uint8_t>(row.surface[x + i] ? 255 : 0),
               counted = static_cast<std::uint8_t>(i >= skipped ? 255 : 0);
    const auto lit = static_cast<std::uint8_t>(hand & light),
               unlit = static_cast<std::uint8_t>(hand & ~light);
    row.surface[x + i] &= static_cast<SurfaceId>(hand | ~counted);
    row.unlit[x + i] = unlit;
    sums.lit[i] = static_cast<std::uint8_t>(sums.lit[i] + (lit & counted & 1));
    sums.unlit[i] = static_cast<std::uint8_t>(sums.unlit[i] + (unlit & counted & 1));
    sums.spilt[i] |= ~hand & light & counted;
  }
}

struct RowCounts {
  int lit = 0, unlit = 0;
  bool is_spilt = false;  ///< there is light outside the hand
};

/// Sorts the pixels [x0, x1) of a row into the regions. `unlit` may be written to the left of them:
/// the last vector ends where the pixels do.
HANDCAST_CLONES RowCounts sort_row(const Sorting row, int x0, int x1) {
  RowSums sums;
  if (x1 < kVector) {
    sort_pixels(row, 0, x1, x0, sums);
  } else {
    for (int x = x0; x < x1; x += kVector) {
      const int first = std::min(x, x1 - kVector);
      sort_pixels(row, first, kVector, x - first, sums);
    }
  }
  RowCounts counts;
  for (int i = 0; i < kVector; ++i) {
    counts.lit += sums.lit[i];
    counts.unlit += sums.unlit[i];
    counts.is_spilt |= sums.spilt[i] != 0;
  }
  return counts;
}

/// Removes the colours of pixels that show nothing.
HANDCAST_CLONES void darken_spilt(const Sorting row, int x0, int x1) {
#pragma GCC ivdep
  for (int x = x0; x < x1; ++x) row.colour[x] = row.surface[x] ? row.colour[x] : 0;
}

/// The bytes that are neither 0 nor 255, as their highest bits.
std::uint64_t partial_bytes(std::uint64_t word) {
  constexpr std::uint64_t kLow = 0x7f7f7f7f7f7f7f7f;
  const auto set = [](std::uint64_t bytes) { return ((bytes & kLow) + kLow) | bytes; };
  return set(word) & set(~word) & ~kLow;
}

constexpr int kSame = 32;  ///< pixels that are skipped at once
/// True if kSame pixels are all 0 or all 255.
bool is_uniform(const std::uint8_t* mask) {
  std::uint64_t any = 0, all = ~std::uint64_t{0};
  for (int i = 0; i < kSame; i += 8) {
    any |= load_eight(mask + i);
    all &= load_eight(mask + i);
  }
  return any == 0 || all == ~std::uint64_t{0};
}

/// The colour of a pixel with the same part of its light as the part of it that is hand.
std::uint32_t softened(std::uint32_t colour, std::uint8_t mask) {
  static const ShareTable kTable = share_table();
  if (mask == 0 || mask == 255 || colour == 0) return colour;
  return dimmed(colour, kTable[mask]) | alpha_in_part(colour >> 24, mask) << 24;
}

/// Softens the pixels [x0, x1) of a row.
void soften_row(const std::uint8_t* mask, std::uint32_t* colour, int x0, int x1) {
  int x = x0;
  for (; x + 8 <= x1; x += 8) {
    while (x + kSame <= x1 && is_uniform(mask + x)) x += kSame;
    if (x + 8 > x1) break;
    for (std::uint64_t left = partial_bytes(load_eight(mask + x)); left != 0; left &= left - 1) {
      const int at = x + std::countr_zero(left) / 8;
      colour[at] = softened(colour[at], mask[at]);
    }
  }
  for (; x < x1; ++x) colour[x] = softened(colour[x], mask[x]);
}

HANDCAST_CLONES void mix_patches(const Lookup& at, const float* factor, std::uint32_t* colours) {
  mix(at, factor, colours);
}

/// Asks for [x0, x1) of a row: the processor does not foresee where the next row of a region
/// begins.
template <class T>
void prefetch(const T* row, int x0, int x1) {
  constexpr int kLine = 64 / sizeof(T);
  for (int x = x0; x < x1 + kLine - 1; x += kLine) __builtin_prefetch(row + x);
}

View<const std::uint8_t> part_of(const Plane<std::uint8_t>& plane, Rect region) {
  return {plane.row(region.y0) + region.x0, region.width(), region.height(), plane.stride()};
}

}  // namespace

FillCounts Filler::sort_pixels(View<const std::uint8_t> mask, Rect region, FrameBuffer& frame) {
  FillCounts counts;
  unlit_rows_ = {};
  for (int y = region.y0; y < region.y1; ++y) {
    if (const int soon = y + 2; soon < region.y1) {
      prefetch(mask.row(soon), region.x0, region.x1);
      prefetch(frame.surface.row(soon), region.x0, region.x1);
      prefetch(frame.colour.row(soon), frame.lit[soon].x0, frame.lit[soon].x1);
    }
    const Sorting row{mask.row(y), frame.surface.row(y), frame.colour.row(y), unlit_.row(y)};
    const RowCounts found = sort_row(row, region.x0, region.x1);
    const Span span = frame.lit[y].within(region.x0, region.x1);
    if (found.is_spilt && !span.empty()) darken_spilt(row, span.x0, span.x1);
    if (!span.empty()) soften_row(row.mask, row.colour, span.x0, span.x1);
    counts.lit += found.lit;
    counts.dark += found.unlit;
    if (found.unlit > 0) unlit_rows_ = unlit_rows_.joined({y - region.y0, y - region.y0 + 1});
  }
  return counts;
}

void Filler::make_patches(const config::Fill& settings, Rect region,
                          std::span<const Sampler> samplers, const FrameBuffer& frame) {
  table_.set_up(settings);
  nearest_.start(part_of(frame.surface, region), part_of(unlit_, region),
                 {0, unlit_rows_.x0, region.width(), unlit_rows_.x1}, table_.reach_px);
  for (int row = unlit_rows_.x0; row < unlit_rows_.x1; ++row)
    for (const NearestSeed& seed : nearest_.of_row(row)) add_patch(seed, region, samplers, frame);
}

void Filler::add_patch(const NearestSeed& seed, Rect region, std::span<const Sampler> samplers,
                       const FrameBuffer& frame) {
  const std::uint32_t full = table_.strength[seed.squared_px];
  if (full == 0) return;
  const int x = seed.x + region.x0, y = seed.y + region.y0;
  const int seed_x = x + seed.dx, seed_y = y + seed.dy;
  const int mirror_x = seed_x + seed.dx, mirror_y = seed_y + seed.dy;
  const SurfaceId surface = frame.surface.row(seed_y)[seed_x];
  const std::uint16_t shade = frame.shade.row(seed_y)[seed_x];
  const Sampler& sampler = samplers[surface / 64];
  const TexelMap& map = sampler.maps()[level_of(shade)];
  glm::vec2 place = frame.place.row(seed_y)[seed_x];
  const bool inside = mirror_x >= region.x0 && mirror_x < region.x1 && mirror_y >= region.y0 &&
                      mirror_y < region.y1;
  if (inside && frame.surface.row(mirror_y)[mirror_x] == surface) {
    glm::vec2 mirrored = frame.place.row(mirror_y)[mirror_x];
    if (const std::uint16_t its = frame.shade.row(mirror_y)[mirror_x];
        level_of(its) != level_of(shade))
      mirrored = map.place(sampler.maps()[level_of(its)].uv(mirrored));
    const glm::vec2 step = place - mirrored, step_uv = step * map.inverse_scale;
    if (glm::dot(step_uv, step_uv) <= table_.squared_limit_uv[seed.squared_px]) place += step;
  }
  patches_.push_back({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), place,
                      static_cast<float>(light_of(shade) * full) / (255 * 256), shade, surface,
                      table_.alpha[seed.squared_px]});
}

void Filler::apply_patches(std::span<const Patch> patches, View<const std::uint8_t> mask,
                           std::span<const Sampler> samplers, FrameBuffer& frame) {
  constexpr std::size_t kCount = Lookup::kCount;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = patches[i];
    const Sampler& sampler = samplers[patch.surface / 64];
    auto& [at, factor] = places_[i / kCount];
    const auto lane = static_cast<int>(i % kCount);
    const glm::vec2 place = sampler.maps()[level_of(patch.shade)].within(patch.place);
    at.set(lane, place.x, place.y, sampler.stride, sampler.fraction);
    at.read(lane, sampler.texels, sampler.stride);
    factor[lane] = patch.factor;
  }
  alignas(64) std::array<std::uint32_t, kCount> colours;
  for (std::size_t first = 0; first < patches.size(); first += kCount) {
    mix_patches(places_[first / kCount].at, places_[first / kCount].factor, colours.data());
    for (std::size_t i = first; i < std::min(first + kCount, patches.size()); ++i)
      put(patches[i], colours[i - first], mask, frame);
  }
}

void Filler::put(const Patch& patch, std::uint32_t colour, View<const std::uint8_t> mask,
                 FrameBuffer& frame) {
  frame.lit[patch.y] = frame.lit[patch.y].joined({patch.x, patch.x + 1});
  frame.colour.row(patch.y)[patch.x] =
      softened(colour | std::uint32_t{patch.alpha} << 24, mask.at(patch.x, patch.y));
}

void Filler::add_surfaces(int step, FrameBuffer& frame) const {
  for (const Patch& patch : patches_) {
    if (patch.x % step != 0 || patch.y % step != 0) continue;
    frame.place.row(patch.y)[patch.x] = patch.place;
    frame.surface.row(patch.y)[patch.x] = patch.surface;
    frame.shade.row(patch.y)[patch.x] = patch.shade;
  }
}

FillCounts Filler::fill(View<const std::uint8_t> mask, const config::Fill& settings, Rect region,
                        std::span<const Sampler> samplers, FrameBuffer& frame) {
  patches_.clear();
  FillCounts counts = sort_pixels(mask, region, frame);
  if (counts.lit != 0 && counts.dark != 0) {
    make_patches(settings, region, samplers, frame);
    constexpr std::size_t kSome = std::tuple_size_v<decltype(places_)> * Lookup::kCount;
    for (std::size_t first = 0; first < patches_.size(); first += kSome)
      apply_patches(std::span(patches_).subspan(first, std::min(kSome, patches_.size() - first)),
                    mask, samplers, frame);
    counts.filled = static_cast<int>(patches_.size());
    counts.dark -= counts.filled;
  }
  return counts;
}

}  // namespace handcast::renderer::cpu
