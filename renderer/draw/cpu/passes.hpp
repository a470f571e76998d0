// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/draw/cpu/frame_buffer.hpp"
#include "renderer/draw/cpu/nearest_pixel.hpp"
#include "renderer/draw/cpu/raster.hpp"
#include "renderer/draw/painter.hpp"

/// The painter's passes. Every region is within the image.
namespace handcast::renderer::cpu {

/// Two steps: geometry into a raster target, then colour for the pixels that stayed visible.
class Drawer {
 public:
  void draw(std::span<const DrawnHand> hands, Rect region, RasterTarget& target, FrameBuffer& out);

 private:
  void rasterise_hand(const DrawnHand& hand, int index, Rect region, RasterTarget& target);

  std::vector<Corner> corners_;
  std::vector<std::int64_t> areas_;
  std::vector<std::uint8_t> ids_;
  std::vector<Sampler> samplers_;
};

/// Rasterises the moved cells with the source pixel as what is interpolated, then fetches the
/// drawing from there (nearest pixel). Where cells overlap, the one that comes later in the grid
/// (row by row, then along the row) wins. The outermost cells reach half a pixel further, to the
/// edge of the corner pixels, so that the grid at rest moves nothing and loses nothing.
class Warper {
 public:
  void warp(const WarpGrid& grid, Rect from, Rect region, const FrameBuffer& in,
            RasterTarget& target, FrameBuffer& out);

 private:
  void place_nodes(const WarpGrid& grid);
  void list_cells(const WarpGrid& grid, Rect from);

  std::vector<Corner> corners_;
  std::vector<TriangleIndices> triangles_;
  std::vector<std::int64_t> areas_;
  std::vector<std::uint8_t> ids_;
};

/// The paper's perceptual boundary reduction (section "Perceptual Boundary Reduction", METHOD
/// section 1). A pixel without light takes the surface of its nearest lit one, p_D, with uv(p_C) =
/// 2 uv(p_D) - uv(p'_D), p'_D being p_C reflected at p_D; or uv(p_D) where p'_D is unlit, on
/// another surface, or the step between them is longer than seam_limit_uv.
class Filler {
 public:
  Filler(int width, int height) : lit_(width, height), unlit_(width, height) {}

  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings, Rect region,
                  std::span<const Texture* const> textures, FrameBuffer& frame);

 private:
  struct Patch {
    std::int16_t x, y;
    glm::vec2 uv;
    const std::uint32_t* texel;
    std::uint16_t factor;  ///< of the texel's colour, 0..256: light and strength of the fill
    std::uint8_t alpha;
    SurfaceId surface;
    std::uint8_t light;
  };
  static constexpr int kSquares = NearestPixel::kLargestReach * NearestPixel::kLargestReach + 1;

  void set_up(const config::Fill& settings);
  FillCounts sort_pixels(View<const std::uint8_t> mask, Rect region, FrameBuffer& frame);
  void make_patches(const config::Fill& settings, Rect region,
                    std::span<const Texture* const> textures, const FrameBuffer& frame);
  void apply_patches(FrameBuffer& frame) const;

  Plane<std::uint8_t> lit_, unlit_;  ///< regions D and C of the paper, 255 or 0
  NearestPixel nearest_;
  std::vector<Patch> patches_;
  int reach_px_ = 0;
  double fade_px_ = 0, seam_uv_ = 0;
  std::array<std::uint16_t, kSquares> strength_{};  ///< 0..256, by the square of a fill's length
  std::array<float, kSquares> squared_limit_uv_{};  ///< seam_limit_uv squared, by the same
};

/// A seam is told by the step in texture coordinates over a reflection. `seam_uv` holds for
/// reflections up to 8 px; beyond, a smooth surface makes steps in proportion to the distance, and
/// so does the limit.
inline float seam_limit_uv(const config::Fill& settings, float distance_px) {
  return static_cast<float>(settings.seam_uv) * std::max(1.f, distance_px / 8.f);
}

}  // namespace handcast::renderer::cpu
