// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/correct/deform.hpp"
#include "renderer/draw/cpu/crew.hpp"
#include "renderer/draw/cpu/fill_table.hpp"
#include "renderer/draw/cpu/frame_buffer.hpp"
#include "renderer/draw/cpu/nearest_pixel.hpp"
#include "renderer/draw/cpu/raster.hpp"
#include "renderer/draw/cpu/sampler.hpp"
#include "renderer/draw/cpu/warp_cells.hpp"
#include "renderer/draw/painter.hpp"

/// The passes of the painter on the processor. Every region must be within the image. One thread.
namespace handcast::renderer::cpu {

/// Draws in two steps: geometry into a raster target, then colour for the visible pixels.
class Drawer {
 public:
  /// Allocates nothing later for hands of at most 4096 vertices.
  Drawer();

  /// Draws `hands` into `region` of `out`. `samplers`: of their pictures. `targets`, one
  /// for each thread of the crew, are overwritten, a band at a time.
  void draw(std::span<const DrawnHand> hands, std::span<const Sampler> samplers, Rect region,
            Crew& crew, std::span<RasterTarget> targets, FrameBuffer& out);

 private:
  /// A hand in the projector's image.
  struct Placed {
    std::vector<Corner> corners;
    std::vector<std::int64_t> areas;
    std::vector<std::uint8_t> ids;
    TriangleList list;
    TriangleBins bins;
  };
  void place(const DrawnHand& hand, const Sampler& sampler, int index, Rect region);

  std::array<Placed, 4> placed_;  ///< by index, see surface_id()
};

/// Rasterises the moved cells of a grid with their source positions as the interpolated values,
/// then copies the drawing from there (nearest pixel). Where cells overlap, the later one in the
/// grid wins (row by row, from the left).
class Warper {
 public:
  /// Allocates nothing later for grids of at most 16,384 cells.
  Warper();

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
  Filler(int width, int height) : unlit_(width, height), nearest_(width, height) {
    patches_.reserve(static_cast<std::size_t>(width) * height / 8);
  }

  /// Removes light outside `mask` and fills inside it, in `region` of `frame`. `samplers`: those of
  /// the drawing.
  FillCounts fill(View<const std::uint8_t> mask, const config::Fill& settings, Rect region,
                  std::span<const Sampler> samplers, FrameBuffer& frame);
  /// Forgets the last fill: its frame is drawn anew.
  void forget() { patches_.clear(); }
  /// Adds to `frame`, after a fill, what the filled pixels show whose coordinates are multiples of
  /// `step`. Their colours are there already, and nothing else is needed to project them.
  void add_surfaces(int step, FrameBuffer& frame) const;

 private:
  struct Patch {
    std::int16_t x, y;
    glm::vec2 place;
    float factor;  ///< of the picture's levels, 0..1: light times strength of the fill
    std::uint16_t shade;
    SurfaceId surface;
    std::uint8_t alpha;
  };
  FillCounts sort_pixels(View<const std::uint8_t> mask, Rect region, FrameBuffer& frame);
  void make_patches(const config::Fill& settings, Rect region, std::span<const Sampler> samplers,
                    const FrameBuffer& frame);
  void add_patch(const NearestSeed& seed, Rect region, std::span<const Sampler> samplers,
                 const FrameBuffer& frame);
  void apply_patches(std::span<const Patch> patches, View<const std::uint8_t> mask,
                     std::span<const Sampler> samplers, FrameBuffer& frame);
  static void put(const Patch& patch, std::uint32_t colour, View<const std::uint8_t> mask,
                  FrameBuffer& frame);

  Plane<std::uint8_t> unlit_;  ///< region C of the paper, 255 or 0
  Span unlit_rows_;            ///< outside of these rows of the region there is none of it
  NearestPixel nearest_;
  std::vector<Patch> patches_;
  /// The places of some patches, 16 at once, and their factors. All are read before the first is
  /// mixed, so that no vector waits for what was just written number by number.
  struct Places {
    Lookup at{};
    alignas(64) float factor[Lookup::kCount] = {};
  };
  std::array<Places, 16> places_{};
  FillTable table_;
};

}  // namespace handcast::renderer::cpu
