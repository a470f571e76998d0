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
static_assert(sizeof(Vertex) == HandAssets::kVertexBytes);

Image2d copy_texels(Context& context, View<const std::uint32_t> texels) {
  Image2d image = make_image(context, GL_R32UI, texels.width, texels.height);
  context.gl().TextureSubImage2D(image.name(), 0, 0, 0, texels.width, texels.height, GL_RED_INTEGER,
                                 GL_UNSIGNED_INT, texels.data);
  return image;
}

}  // namespace

HandAssets AssetCache::copy(const DrawnHand& hand) {
  static const MipChain kWhite;
  const MipChain& content = hand.texture != nullptr ? *hand.texture : kWhite;
  const HandMesh& mesh = *hand.mesh;
  std::vector<Vertex> vertices(mesh.vertex_count());
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = {mesh.uv[i], mesh.chart[i]};
  return {make_buffer(context_, vertices.size() * sizeof(Vertex), 0, vertices.data()),
          make_buffer(context_, mesh.triangles.size() * sizeof(mesh.triangles[0]), 0,
                      mesh.triangles.data()),
          static_cast<GLsizei>(3 * mesh.triangles.size()),
          copy_texels(context_, content.texels()),
          {content.width(), content.height(), content.padded_height(),
           content.smooth() ? content.levels() - 1 : -1},
          hand.revision};
}

HandAssets& AssetCache::assets_of(const DrawnHand& hand) {
  if (hand.revision != 0) {
    for (const auto& one : kept_)
      if (one->revision == hand.revision) return *one;
  }
  return *kept_.emplace_back(std::make_unique<HandAssets>(copy(hand)));
}

std::span<const HandAssets* const> AssetCache::find(std::span<const DrawnHand> hands) {
  ++draws_;
  std::erase_if(kept_, [](const auto& one) { return one->revision == 0; });
  while (kept_.size() > kKept)
    kept_.erase(std::ranges::min_element(kept_, {}, [](const auto& one) { return one->used; }));
  found_.clear();
  for (const DrawnHand& hand : hands) {
    HandAssets& assets = assets_of(hand);
    assets.used = draws_;
    found_.push_back(&assets);
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
