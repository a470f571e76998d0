// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/draw/cpu/fill_table.hpp"
#include "renderer/draw/cpu/raster.hpp"
#include "renderer/draw/cpu/warp_cells.hpp"
#include "renderer/draw/gl/objects.hpp"
#include "renderer/draw/gl/program.hpp"
#include "renderer/draw/painter.hpp"

/// The passes of the painter on the GPU. Every region must be within the image. One thread.
namespace handcast::renderer::gl {

/// A mesh in the GPU's memory.
struct MeshCopy {
  Buffer vertices;             ///< per vertex: texture coordinates (2 floats), chart (uint)
  Buffer triangles;            ///< three indices of 16 bits each
  GLsizei index_count = 0;     ///< three times the number of triangles
  std::uint64_t revision = 0;  ///< DrawnHand::mesh_revision of the copy
  std::uint64_t used = 0;      ///< number of the last draw that used it

  /// Bytes of a vertex.
  static constexpr GLsizei kVertexBytes = 12;
};

/// A picture in the GPU's memory.
struct PictureCopy {
  Image2d texels;              ///< R32UI: MipView::all()
  msg::MipLayout layout;       ///< how they lie
  std::uint64_t revision = 0;  ///< DrawnHand::picture_revision of the copy
  std::uint64_t used = 0;      ///< number of the last draw that used it

  /// See `picture` in shaders/common.glsl.
  glm::ivec4 place() const {
    return {layout.width, layout.height, layout.padded_height(),
            layout.smooth ? layout.levels() - 1 : -1};
  }
};

/// The copies of what one hand is drawn from.
struct HandAssets {
  const MeshCopy* mesh;
  const PictureCopy* picture;
};

/// Keeps the copies of the meshes and pictures drawn last. Content changes its pictures many times
/// a second: a copy that is no longer used is overwritten by a picture of its size.
class AssetCache {
 public:
  /// Without copies.
  explicit AssetCache(Context& context) : context_(context) {}

  /// The assets of each of up to four hands, copied if they are new. Valid until the next call.
  std::span<const HandAssets> find(std::span<const DrawnHand> hands);

 private:
  static constexpr std::size_t kKept = 8;

  MeshCopy& mesh_of(const DrawnHand& hand);
  PictureCopy& picture_of(const DrawnHand& hand);
  MeshCopy copy(const HandMesh& mesh, std::uint64_t revision);
  std::unique_ptr<PictureCopy> spare(const msg::MipLayout& layout);

  Context& context_;
  std::vector<std::unique_ptr<MeshCopy>> meshes_;
  std::vector<std::unique_ptr<PictureCopy>> pictures_;
  std::vector<HandAssets> found_;
  std::uint64_t draws_ = 0;
};

/// The drawing between the passes, in the projector's size: the planes of cpu::FrameBuffer. Row 0
/// is the top row, as in all images.
struct Layers {
  /// A dark drawing. `depth`: a texture for the framebuffer; layers may share it.
  Layers(Context& context, int width, int height, GLuint depth);

  Image2d uv;      ///< RG32F: texture coordinates; undefined where dark
  Image2d tag;     ///< RGBA8UI: surface id (0 where dark), shading factor, level of the picture
  Image2d colour;  ///< R32UI: RGBA8 with red in the lowest byte; 0 where dark
  /// Has `uv`, `tag` and `colour` as colour attachments 0, 1 and 2.
  Framebuffer framebuffer;
};

/// Prepares the framebuffer for a pass that changes `region` only, and makes the region dark and
/// infinitely far.
void begin_drawing(Context& context, const Layers& layers, const Rect& region);

/// Draws the hands: corners are snapped, and the far side is left out, as by the cpu painter, so
/// that both light the same pixels.
class Drawer {
 public:
  /// Errors (unavailable): those of make_program().
  static Result<Drawer> create(Context& context, glm::ivec2 size_px);
  /// Draws `hands` into `region` of `out`; nothing if the context is lost.
  void draw(std::span<const DrawnHand> hands, std::span<const HandAssets> assets,
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
  void fill(const config::Fill& settings, const Rect& region, std::span<const HandAssets> contents,
            const Layers& frame);
  /// The counts of the last fill(), valid after the commands up to now are finished (wait()).
  FillCounts counts() const;

 private:
  /// The buffer `Counts` of the shaders.
  struct Counts {
    std::uint32_t groups_x, groups_y, groups_z, lit, wanted, filled;
  };

  Filler(Context& context, Program sort, Program fill, glm::ivec2 size_px);
  void set_table(const config::Fill& settings);
  void bind(std::span<const HandAssets> contents, const Layers& frame) const;

  Context* context_;
  Program sort_, fill_;
  Image2d mask_;
  std::unique_ptr<UploadRing> ring_;
  cpu::FillTable table_;
  Buffer words_, list_, counts_, limits_, shares_;
  MappedBuffer counts_read_;
};

/// Copies of the layers in the processor's memory. Only what changed since the last copy is read
/// back.
class ReadBack {
 public:
  /// Copies of a dark drawing of this size.
  ReadBack(Context& context, int width, int height);

  /// Notes that `region` was drawn into.
  void changed(const Rect& region);
  /// Issues the commands that copy the changed colours. They are in colour() after wait().
  void queue_colour(const Layers& layers);
  /// Copies the changed colours, texture coordinates or surface ids, and waits for them.
  /// @{
  View<const std::uint32_t> colour(const Layers& layers);
  View<const glm::vec2> uv(const Layers& layers);
  View<const SurfaceId> surface(const Layers& layers);
  /// @}

 private:
  void read(const Layers& layers, GLenum attachment, const Rect& region, GLenum format, GLenum type,
            void* pixels) const;

  Context& context_;
  int width_, height_;
  MappedBuffer colour_;
  Image<glm::vec2> uv_;
  Image<SurfaceId> surface_;
  Rect stale_colour_, stale_uv_, stale_surface_;
};

}  // namespace handcast::renderer::gl
