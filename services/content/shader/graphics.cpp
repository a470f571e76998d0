// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/graphics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace handcast::content::shader {
namespace {

/// Stays open when no shader is shown, because opening takes a fifth of a second; never destroyed,
/// because OpenGL may be gone at the exit.
std::shared_ptr<Graphics>& shared_graphics() {
  static auto& graphics = *new std::shared_ptr<Graphics>;
  return graphics;
}

/// The three colours of a texel times its alpha, rounded.
std::uint32_t premultiplied(std::uint32_t texel) {
  const std::uint32_t alpha = texel >> 24;
  if (alpha == 255) return texel;
  const auto scaled = [&](std::uint32_t level) { return (level * alpha + 127) / 255; };
  return alpha << 24 | scaled(texel >> 16 & 255) << 16 | scaled(texel >> 8 & 255) << 8 |
         scaled(texel & 255);
}

std::uint32_t straight(std::uint32_t texel) {
  const std::uint32_t alpha = texel >> 24;
  if (alpha == 255 || alpha == 0) return texel;
  const auto scaled = [&](std::uint32_t level) {
    return std::min<std::uint32_t>(255, (level * 255 + alpha / 2) / alpha);
  };
  return alpha << 24 | scaled(texel >> 16 & 255) << 16 | scaled(texel >> 8 & 255) << 8 |
         scaled(texel & 255);
}

}  // namespace

Result<std::shared_ptr<Graphics>> Graphics::open() {
  if (const auto& shared = shared_graphics(); shared && !shared->context_->lost()) return shared;
  auto context = gl::Context::open();
  if (!context)
    return fail(Errc::unavailable,
                fmt::format("shaders need OpenGL 4.5 ({})", context.error().what));
  std::shared_ptr<Graphics> graphics(new Graphics(std::move(*context)));
  shared_graphics() = graphics;
  return graphics;
}

Graphics::Graphics(std::unique_ptr<gl::Context> context) : context_(std::move(context)) {
  corners_ = gl::make_vertex_array(*context_);
  functions().PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const std::uint32_t none = 0;
  upload(nothing_, {&none, 1, 1, 1}, false);
}

Result<void> Graphics::use() {
  if (context_->make_current()) return {};
  return fail(Errc::unavailable, "OpenGL is lost: " + context_->lost().value_or("no reason given"));
}

Result<void> Graphics::check() {
  context_->check();
  if (!context_->lost()) return {};
  return fail(Errc::unavailable, "OpenGL is lost: " + *context_->lost());
}

Texels Graphics::make_texels(GLenum format, int width, int height) {
  Texels texels{gl::make_image(*context_, format, width, height), width, height, format};
  const auto set = [&](GLenum name, GLint value) {
    functions().TextureParameteri(texels.image.name(), name, value);
  };
  set(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  set(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  set(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texels;
}

Target Graphics::make_target(GLenum format, int width, int height) {
  Target target{make_texels(format, width, height), gl::make_framebuffer(*context_)};
  functions().NamedFramebufferTexture(target.framebuffer.name(), GL_COLOR_ATTACHMENT0,
                                      target.texels.image.name(), 0);
  constexpr std::array<GLfloat, 4> kClear{};
  functions().ClearNamedFramebufferfv(target.framebuffer.name(), GL_COLOR, 0, kClear.data());
  return target;
}

void Graphics::upload(Texels& texels, renderer::View<const std::uint32_t> picture,
                      bool is_premultiplied) {
  if (picture.width <= 0 || picture.height <= 0) return;
  if (texels.width != picture.width || texels.height != picture.height)
    texels = make_texels(GL_RGBA8, picture.width, picture.height);
  scratch_.resize(static_cast<std::size_t>(picture.width) * picture.height);
  std::uint32_t* to = scratch_.data();
  for (int y = picture.height - 1; y >= 0; --y, to += picture.width) {
    const std::uint32_t* const from = picture.row(y);
    if (is_premultiplied)
      std::transform(from, from + picture.width, to, straight);
    else
      std::copy(from, from + picture.width, to);
  }
  functions().TextureSubImage2D(texels.image.name(), 0, 0, 0, picture.width, picture.height,
                                GL_RGBA, GL_UNSIGNED_BYTE, scratch_.data());
}

void Graphics::upload_levels(Texels& texels, int width, int height, std::span<const float> levels) {
  if (texels.width != width || texels.height != height) {
    texels = make_texels(GL_R32F, width, height);
    for (const GLenum channel : {GL_TEXTURE_SWIZZLE_G, GL_TEXTURE_SWIZZLE_B})
      functions().TextureParameteri(texels.image.name(), channel, GL_RED);
  }
  functions().TextureSubImage2D(texels.image.name(), 0, 0, 0, width, height, GL_RED, GL_FLOAT,
                                levels.data());
}

void Graphics::read(const Target& target, renderer::Texture& out) {
  const int width = target.texels.width, height = target.texels.height;
  if (out.width() != width || out.height() != height) out = renderer::Texture(width, height);
  scratch_.resize(static_cast<std::size_t>(width) * height);
  functions().BindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer.name());
  functions().ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, scratch_.data());
  for (int y = 0; y < height; ++y) {
    const std::uint32_t* const from =
        scratch_.data() + static_cast<std::size_t>(height - 1 - y) * width;
    std::transform(from, from + width, out.row(y), premultiplied);
  }
}

void Graphics::draw(const Target& target, bool clears) {
  const auto& gl = functions();
  constexpr std::array<GLfloat, 4> kClear{};
  if (clears) gl.ClearNamedFramebufferfv(target.framebuffer.name(), GL_COLOR, 0, kClear.data());
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer.name());
  gl.Viewport(0, 0, target.texels.width, target.texels.height);
  gl.BindVertexArray(corners_.name());
  gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace handcast::content::shader
