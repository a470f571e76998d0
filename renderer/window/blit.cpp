// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/blit.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace handcast::renderer {

Blit::Blit() {
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glClearColor(0, 0, 0, 1);
}

Blit::~Blit() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
}

/// Copies the region to the texture, which gets the size of the picture.
void Blit::upload(View<const std::uint32_t> picture, const Rect& region) {
  glBindTexture(GL_TEXTURE_2D, texture_);
  if (picture.width != width_px_ || picture.height != height_px_) {
    width_px_ = picture.width;
    height_px_ = picture.height;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px_, height_px_, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 nullptr);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, picture.stride);
  glTexSubImage2D(GL_TEXTURE_2D, 0, region.x0, region.y0, region.width(), region.height(), GL_RGBA,
                  GL_UNSIGNED_BYTE, &picture.at(region.x0, region.y0));
}

void Blit::finish() { glFinish(); }

void Blit::draw(View<const std::uint32_t> picture, Rect region, int to_width_px, int to_height_px) {
  glClear(GL_COLOR_BUFFER_BIT);
  region = region.within(picture.width, picture.height);
  if (region.empty()) return;
  upload(picture, region);
  const bool is_scaled = to_width_px != picture.width || to_height_px != picture.height;
  // The rows of a window run from the bottom to the top.
  const auto x = [&](int px) { return px * to_width_px / picture.width; };
  const auto y = [&](int px) { return to_height_px - px * to_height_px / picture.height; };
  glBlitFramebuffer(region.x0, region.y0, region.x1, region.y1, x(region.x0), y(region.y0),
                    x(region.x1), y(region.y1), GL_COLOR_BUFFER_BIT,
                    is_scaled ? GL_LINEAR : GL_NEAREST);
}

}  // namespace handcast::renderer
