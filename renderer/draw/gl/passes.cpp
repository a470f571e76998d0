// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/passes.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace handcast::renderer::gl {
namespace {

struct Vertex {
  glm::vec2 uv;
  std::uint32_t chart;
};
static_assert(sizeof(Vertex) == MeshCopy::kVertexBytes);

bool is_same(const msg::MipLayout& a, const msg::MipLayout& b) {
  return a.width == b.width && a.height == b.height && a.smooth == b.smooth;
}

/// Forgets the copies of contents that may have changed, and the least recently used of too many.
template <class Copy>
void trim(std::vector<std::unique_ptr<Copy>>& kept, std::size_t most) {
  std::erase_if(kept, [](const auto& one) { return one->revision == 0; });
  while (kept.size() > most)
    kept.erase(std::ranges::min_element(kept, {}, [](const auto& one) { return one->used; }));
}

/// The copy with a revision; null if there is none.
template <class Copy>
Copy* find_copy(const std::vector<std::unique_ptr<Copy>>& kept, std::uint64_t revision) {
  for (const auto& one : kept)
    if (revision != 0 && one->revision == revision) return one.get();
  return nullptr;
}

}  // namespace

MeshCopy AssetCache::copy(const HandMesh& mesh, std::uint64_t revision) {
  std::vector<Vertex> vertices(mesh.vertex_count());
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = {mesh.uv[i], mesh.chart[i]};
  return {make_buffer(context_, vertices.size() * sizeof(Vertex), 0, vertices.data()),
          make_buffer(context_, mesh.triangles.size() * sizeof(mesh.triangles[0]), 0,
                      mesh.triangles.data()),
          static_cast<GLsizei>(3 * mesh.triangles.size()), revision};
}

MeshCopy& AssetCache::mesh_of(const DrawnHand& hand) {
  if (auto* kept = find_copy(meshes_, hand.mesh_revision)) return *kept;
  return *meshes_.emplace_back(std::make_unique<MeshCopy>(copy(*hand.mesh, hand.mesh_revision)));
}

/// A place for a picture: that of one of its size which the last two drawings did not use, or a new
/// one.
std::unique_ptr<PictureCopy> AssetCache::spare(const msg::MipLayout& layout) {
  const auto old = std::ranges::find_if(pictures_, [&](const auto& one) {
    return one->used + 2 < draws_ && is_same(one->layout, layout);
  });
  if (old == pictures_.end())
    return std::make_unique<PictureCopy>(
        PictureCopy{make_image(context_, GL_R32UI, layout.stride(), layout.rows()), layout});
  auto reused = std::move(*old);
  pictures_.erase(old);
  return reused;
}

PictureCopy& AssetCache::picture_of(const DrawnHand& hand) {
  static const MipChain kWhite;
  if (auto* kept = find_copy(pictures_, hand.picture_revision)) return *kept;
  const MipView content = hand.picture.texels != nullptr ? hand.picture : kWhite.view();
  const View<const std::uint32_t> texels = content.all();
  auto& made = pictures_.emplace_back(spare(content.layout));
  made->revision = hand.picture_revision;
  context_.gl().TextureSubImage2D(made->texels.name(), 0, 0, 0, texels.width, texels.height,
                                  GL_RED_INTEGER, GL_UNSIGNED_INT, texels.data);
  return *made;
}

std::span<const HandAssets> AssetCache::find(std::span<const DrawnHand> hands) {
  ++draws_;
  trim(meshes_, kKept);
  trim(pictures_, kKept);
  found_.clear();
  for (const DrawnHand& hand : hands) {
    MeshCopy& mesh = mesh_of(hand);
    PictureCopy& picture = picture_of(hand);
    mesh.used = picture.used = draws_;
    found_.push_back({&mesh, &picture});
  }
  return found_;
}

Layers::Layers(Context& context, int width, int height, GLuint depth)
    : uv(make_image(context, GL_RG32F, width, height)),
      tag(make_image(context, GL_RGBA8UI, width, height)),
      colour(make_image(context, GL_R32UI, width, height)),
      framebuffer(make_framebuffer(context)) {
  const Functions& gl = context.gl();
  const std::array planes{uv.name(), tag.name(), colour.name()};
  for (GLuint i = 0; i < planes.size(); ++i)
    gl.NamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0 + i, planes[i], 0);
  gl.NamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth, 0);
  constexpr std::array<GLenum, 3> kTargets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                           GL_COLOR_ATTACHMENT2};
  gl.NamedFramebufferDrawBuffers(framebuffer.name(), kTargets.size(), kTargets.data());
  if (gl.CheckNamedFramebufferStatus(framebuffer.name(), GL_DRAW_FRAMEBUFFER) !=
      GL_FRAMEBUFFER_COMPLETE)
    context.lose("the GPU cannot draw into these formats at once");
  gl.ClearTexImage(uv.name(), 0, GL_RG, GL_FLOAT, nullptr);
  gl.ClearTexImage(tag.name(), 0, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, nullptr);
  gl.ClearTexImage(colour.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void begin_drawing(Context& context, const Layers& layers, const Rect& region) {
  const Functions& gl = context.gl();
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, layers.framebuffer.name());
  gl.Scissor(region.x0, region.y0, region.width(), region.height());
  constexpr std::array<GLuint, 4> kDark{};
  constexpr GLfloat kFar = 1;
  gl.ClearNamedFramebufferuiv(layers.framebuffer.name(), GL_COLOR, 1, kDark.data());
  gl.ClearNamedFramebufferuiv(layers.framebuffer.name(), GL_COLOR, 2, kDark.data());
  gl.ClearNamedFramebufferfv(layers.framebuffer.name(), GL_DEPTH, 0, &kFar);
}

ReadBack::ReadBack(Context& context, int width, int height)
    : context_(context),
      width_(width),
      height_(height),
      colour_(context, sizeof(std::uint32_t) * width * height, GL_MAP_READ_BIT),
      uv_(width, height),
      surface_(width, height),
      stale_colour_{0, 0, width, height} {}

void ReadBack::changed(const Rect& region) {
  for (Rect* stale : {&stale_colour_, &stale_uv_, &stale_surface_}) *stale = stale->joined(region);
}

/// Reads `region` to its place in `pixels`, an image (or an offset in the bound buffer).
void ReadBack::read(const Layers& layers, GLenum attachment, const Rect& region, GLenum format,
                    GLenum type, void* pixels) const {
  const Functions& gl = context_.gl();
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, layers.framebuffer.name());
  gl.NamedFramebufferReadBuffer(layers.framebuffer.name(), attachment);
  gl.PixelStorei(GL_PACK_ROW_LENGTH, width_);
  gl.PixelStorei(GL_PACK_SKIP_PIXELS, region.x0);
  gl.PixelStorei(GL_PACK_SKIP_ROWS, region.y0);
  gl.ReadPixels(region.x0, region.y0, region.width(), region.height(), format, type, pixels);
}

void ReadBack::queue_colour(const Layers& layers) {
  const Rect region = std::exchange(stale_colour_, {});
  if (region.empty()) return;
  const Functions& gl = context_.gl();
  gl.BindBuffer(GL_PIXEL_PACK_BUFFER, colour_.buffer.name());
  read(layers, GL_COLOR_ATTACHMENT2, region, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  gl.BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

View<const std::uint32_t> ReadBack::colour(const Layers& layers) {
  if (!stale_colour_.empty() && context_.make_current()) {
    queue_colour(layers);
    wait(context_, context_.gl().FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    context_.check();
  }
  return {reinterpret_cast<const std::uint32_t*>(colour_.data), width_, height_, width_};
}

View<const glm::vec2> ReadBack::uv(const Layers& layers) {
  if (!stale_uv_.empty() && context_.make_current())
    read(layers, GL_COLOR_ATTACHMENT0, std::exchange(stale_uv_, {}), GL_RG, GL_FLOAT, uv_.row(0));
  return std::as_const(uv_).view();
}

View<const SurfaceId> ReadBack::surface(const Layers& layers) {
  if (!stale_surface_.empty() && context_.make_current())
    read(layers, GL_COLOR_ATTACHMENT1, std::exchange(stale_surface_, {}), GL_RED_INTEGER,
         GL_UNSIGNED_BYTE, surface_.row(0));
  return std::as_const(surface_).view();
}

}  // namespace handcast::renderer::gl
