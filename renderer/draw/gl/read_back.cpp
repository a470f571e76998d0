// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/read_back.hpp"

#include <cstring>
#include <utility>

namespace handcast::renderer::gl {

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
