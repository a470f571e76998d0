// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/layers.hpp"

#include <array>

namespace handcast::renderer::gl {

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

}  // namespace handcast::renderer::gl
