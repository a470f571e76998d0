// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/base/mip_chain.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/draw/cpu/fill_table.hpp"
#include "renderer/draw/cpu/frame_buffer.hpp"
#include "renderer/draw/cpu/nearest_pixel.hpp"
#include "renderer/draw/cpu/raster.hpp"
#include "renderer/draw/cpu/warp_cells.hpp"
#include "renderer/draw/painter.hpp"

/// The passes of the painter on the processor. Every region must be within the image. One thread.
namespace handcast::renderer::cpu {

/// The alpha of an opaque colour.
constexpr std::uint32_t kOpaque = 0xff000000;

/// Red, green and blue of a colour times `factor` / 256 (0..256); alpha 0.
[[gnu::always_inline]] inline std::uint32_t dimmed(std::uint32_t colour, std::uint32_t factor) {
  const std::uint32_t red_blue = ((colour & 0xff00ff) * factor >> 8) & 0xff00ff;
  const std::uint32_t green = ((colour & 0x00ff00) * factor >> 8) & 0x00ff00;
  return red_blue | green;
}

/// Where a picture is read: a texel, and for a filtered one how far the next column and row weigh.
struct Footprint {
  std::int32_t index;  ///< of the upper left texel
  /// Weights of the right and the lower texels, 0..255 of 256.
  /// @{
  std::int32_t right, down;
  /// @}
};

/// The mean of the texels of a footprint by their weights; alpha 0. `upper`, `lower`: the two of a
/// row, the left one in the lower half. The light of a level is taken as its square, which is near
/// to sRGB: the mean of black and white is 180 instead of 188.
[[gnu::always_inline]] inline std::uint32_t mean_of(std::uint64_t upper, std::uint64_t lower,
                                                    const Footprint& place) {
  const std::int32_t both = place.right * place.down >> 8;
  const auto upper_left = static_cast<float>(256 - place.right - place.down + both),
             upper_right = static_cast<float>(place.right - both),
             lower_left = static_cast<float>(place.down - both),
             lower_right = static_cast<float>(both);
  const auto a = static_cast<std::uint32_t>(upper), b = static_cast<std::uint32_t>(upper >> 32),
             c = static_cast<std::uint32_t>(lower), d = static_cast<std::uint32_t>(lower >> 32);
  const auto mean = [&](int shift) {
    const auto square = [shift](std::uint32_t texel) {
      const auto level = static_cast<float>(static_cast<std::int32_t>(texel >> shift & 0xff));
      return level * level;
    };
    const float squares = upper_left * square(a) + upper_right * square(b) +
                          lower_left * square(c) + lower_right * square(d);
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): lround is no vector instruction
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::sqrt(squares) / 16 + 0.5f));
  };
  return mean(0) | mean(8) << 8 | mean(16) << 16;
}

/// Several footprints, and the texels found there.
struct Lookup {
  static constexpr int kCount = 16;
  alignas(64) std::int32_t index[kCount], right[kCount], down[kCount];
  alignas(64) std::uint64_t upper[kCount], lower[kCount];

  Footprint place(int i) const { return {index[i], right[i], down[i]}; }
};

/// Reads a mip chain. Texture coordinates outside 0..1 are clamped; NaN is taken as 0.
struct Sampler {
  /// Borrows the chain; nullptr: white.
  explicit Sampler(const MipChain* picture) {
    static const MipChain kWhite;
    if (picture == nullptr) picture = &kWhite;
    texels = picture->texels().data;
    stride = picture->texels().stride;
    width = static_cast<float>(picture->width());
    height = static_cast<float>(picture->height());
    padded_height = picture->padded_height();
    last_level = picture->levels() - 1;
    smooth = picture->smooth();
  }

  /// The index of the texel of level 0 at texture coordinates (u, v).
  [[gnu::always_inline]] std::int32_t nearest(float u, float v) const {
    const auto column = static_cast<std::int32_t>(std::min(std::max(0.f, u * width), width - 1));
    const auto line = static_cast<std::int32_t>(std::min(std::max(0.f, v * height), height - 1));
    return (line + 1) * stride + column + 1;
  }

  /// The four texels of `level` around texture coordinates (u, v).
  [[gnu::always_inline]] Footprint around(float u, float v, std::int32_t level) const {
    constexpr int kOne = 1 << MipChain::kMostLevels;
    const float scale = static_cast<float>(kOne >> level) / kOne;
    // 0.5 is the centre of the border, and the level begins at 1.
    const float columns = width * scale, rows = height * scale;
    const float x = std::min(std::max(0.f, u * columns), columns) + 0.5f,
                y = std::min(std::max(0.f, v * rows), rows) + 0.5f;
    const auto right = static_cast<std::int32_t>(256 * x),
               down = static_cast<std::int32_t>(256 * y);
    const std::int32_t first_row = 2 * level + 2 * (padded_height - (padded_height >> level));
    return {(first_row + (down >> 8)) * stride + (right >> 8), right & 255, down & 255};
  }

  /// Reads the texels of footprint `i`: four if kSmooth, otherwise one.
  template <bool kSmooth>
  [[gnu::always_inline]] void read(Lookup& at, int i) const {
    if constexpr (kSmooth) {
      std::memcpy(&at.upper[i], texels + at.index[i], sizeof at.upper[i]);
      std::memcpy(&at.lower[i], texels + at.index[i] + stride, sizeof at.lower[i]);
    } else {
      at.upper[i] = texels[at.index[i]];
    }
  }

  const std::uint32_t* texels;  ///< of all levels, RGBA8
  std::int32_t stride;          ///< texels from one row to the next
  /// Size of the picture in texels.
  /// @{
  float width, height;
  /// @}
  std::int32_t padded_height, last_level;  ///< see MipChain
  bool smooth;                             ///< see MipChain::smooth()
};

/// Draws in two steps: geometry into a raster target, then colour for the visible pixels.
class Drawer {
 public:
  /// Draws `hands` into `region` of `out`. `target` is overwritten, a band at a time.
  void draw(std::span<const DrawnHand> hands, Rect region, RasterTarget& target, FrameBuffer& out);

 private:
  /// A hand in the projector's image.
  struct Placed {
    std::vector<Corner> corners;
    std::vector<std::int64_t> areas;
    std::vector<std::uint8_t> ids;
    TriangleList list;
    TriangleBins bins;
  };
  void place(const DrawnHand& hand, int index, Rect region);
  void colour_band(Rect band, RasterTarget& target, FrameBuffer& out) const;

  std::vector<Placed> placed_;  ///< by index; kept for their memory
  std::vector<Sampler> samplers_;
};

/// Rasterises the moved cells of a grid with their source positions as the interpolated values,
/// then copies the drawing from there (nearest pixel). Where cells overlap, the later one in the
/// grid wins (row by row, from the left).
class Warper {
 public:
  /// Warps the part `from` of `in` into `region` of `out`. `target` is overwritten, a band at a
  /// time.
  void warp(const WarpGrid& grid, Rect from, Rect region, const FrameBuffer& in,
            RasterTarget& target, FrameBuffer& out);

 private:
  WarpCells cells_;
  TriangleBins bins_;
  std::vector<std::int64_t> areas_;
  std::vector<std::uint8_t> ids_;
};

/// Fills hand without light (paper, "Perceptual Boundary Reduction"; `docs/method.md#fill`). A
/// pixel p_C without light takes the surface of the nearest lit pixel p_D. With p'_D, p_C reflected
/// at p_D:
///
///     uv(p_C) = 2 uv(p_D) - uv(p'_D)
///
/// or uv(p_D), if p'_D is not lit, is on another surface, or if the step from uv(p'_D) to uv(p_D)
/// is longer than FillTable allows.
class Filler {
 public:
  /// For drawings of the given size in pixels.
  Filler(int width, int height) : lit_(width, height), unlit_(width, height) {}

  /// Removes light outside `mask` and fills inside it, in `region` of `frame`. `textures`: one per
  /// hand of the drawing; nullptr: white.
  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings, Rect region,
                  std::span<const MipChain* const> textures, FrameBuffer& frame);

 private:
  struct Patch {
    std::int16_t x, y;
    glm::vec2 uv;
    const Sampler* sampler;
    Footprint place;
    std::uint16_t factor;  ///< of the picture's colour, 0..256: light times strength of the fill
    std::uint16_t shade;
    SurfaceId surface;
    std::uint8_t alpha;
  };
  FillCounts sort_pixels(View<const std::uint8_t> mask, Rect region, FrameBuffer& frame);
  void make_patches(const config::Fill& settings, Rect region,
                    std::span<const MipChain* const> textures, const FrameBuffer& frame);
  void apply_patches(FrameBuffer& frame) const;
  static void put(const Patch& patch, std::uint32_t colour, FrameBuffer& frame);

  Plane<std::uint8_t> lit_, unlit_;  ///< regions D and C of the paper, 255 or 0
  NearestPixel nearest_;
  std::vector<Sampler> samplers_;
  std::vector<Patch> patches_;
  FillTable table_;
};

}  // namespace handcast::renderer::cpu
