// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/draw/cpu/fill_table.hpp"
#include "renderer/draw/cpu/raster.hpp"
#include "renderer/draw/cpu/warp_cells.hpp"
#include "renderer/draw/gl/hand_assets.hpp"
#include "renderer/draw/gl/layers.hpp"
#include "renderer/draw/gl/program.hpp"
#include "renderer/draw/gl/upload_ring.hpp"
#include "renderer/draw/painter.hpp"

/// The passes of the painter on the GPU. Every region must be within the image. One thread.
namespace handcast::renderer::gl {

/// Draws the hands: corners are snapped, and the far side is left out, as by the cpu painter, so
/// that both light the same pixels.
class Drawer {
 public:
  /// Errors (unavailable): those of make_program().
  static Result<Drawer> create(Context& context, glm::ivec2 size_px);
  /// Draws `hands` into `region` of `out`; nothing if the context is lost.
  void draw(std::span<const DrawnHand> hands, std::span<const HandAssets* const> assets,
            const Rect& region, const Layers& out);

 private:
  /// The values of one vertex that change from frame to frame.
  struct Placed {
    float x_px, y_px, depth_m, light;
  };

  Drawer(Context& context, Program program);
  cpu::Facing place(const DrawnHand& hand, Placed* placed);
  void draw_hand(const HandAssets& assets, int index, cpu::Facing facing, std::size_t offset);

  Context* context_;
  Program program_;
  VertexArray vertices_;
  std::unique_ptr<UploadRing> ring_;
  std::vector<cpu::Corner> corners_;
  std::vector<std::int64_t> areas_;
  std::vector<cpu::Facing> facings_;
};

/// Draws the cells of a grid, each with the nearest pixels of the drawing at rest. Later cells hide
/// earlier ones.
class Warper {
 public:
  /// Errors (unavailable): those of make_program().
  static Result<Warper> create(Context& context, glm::ivec2 size_px);
  /// Warps the part `from` of `in` into `region` of `out`; nothing if the context is lost.
  void warp(const WarpGrid& grid, const Rect& from, const Rect& region, const Layers& in,
            const Layers& out);

 private:
  Warper(Context& context, Program program);

  Context* context_;
  Program program_;
  VertexArray vertices_;
  std::unique_ptr<UploadRing> ring_;
  cpu::WarpCells cells_;
};

/// Fills hand without light, and darkens light without hand, by two compute shaders: see
/// shaders/sort_compute.glsl and shaders/fill_compute.glsl.
class Filler {
 public:
  /// Errors (unavailable): those of make_program().
  static Result<Filler> create(Context& context, glm::ivec2 size_px);
  /// Copies `region` of the mask to the GPU. Returns false if the context is lost.
  bool upload(View<const std::uint8_t> mask, const Rect& region);
  /// Fills `region` of `frame` by the mask uploaded last. `contents`: one per hand.
  void fill(const config::Fill& settings, const Rect& region,
            std::span<const HandAssets* const> contents, const Layers& frame);
  /// The counts of the last fill(), valid after the commands up to now are finished (wait()).
  FillCounts counts() const;

 private:
  /// The buffer `Counts` of the shaders.
  struct Counts {
    std::uint32_t groups_x, groups_y, groups_z, lit, wanted, filled;
  };

  Filler(Context& context, Program sort, Program fill, glm::ivec2 size_px);
  void set_table(const config::Fill& settings);
  void bind(std::span<const HandAssets* const> contents, const Layers& frame) const;

  Context* context_;
  Program sort_, fill_;
  Image2d mask_;
  std::unique_ptr<UploadRing> ring_;
  cpu::FillTable table_;
  Buffer words_, list_, counts_, limits_, shares_;
  MappedBuffer counts_read_;
};

}  // namespace handcast::renderer::gl
