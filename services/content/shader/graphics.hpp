// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "renderer/draw/gl/objects.hpp"

namespace handcast::content::shader {

namespace gl = renderer::gl;

/// A texture that shaders read: smooth, and clamped to its edges.
struct Texels {
  gl::Image2d image;
  int width = 0, height = 0;
  GLenum format = 0;
};

/// A texture that a pass draws into.
struct Target {
  Texels texels;
  gl::Framebuffer framebuffer;
};

/// The OpenGL of all shader sources of a process: a context without a window, which the first of
/// them opens and the last one closes. One thread.
class Graphics {
 public:
  /// Errors (unavailable): there is no OpenGL 4.5.
  static Result<std::shared_ptr<Graphics>> open();

  gl::Context& context() { return *context_; }
  const gl::Functions& functions() const { return context_->gl(); }
  /// Makes the context current. Errors (unavailable): it is lost.
  Result<void> use();
  /// Checks for errors after a picture. Errors (unavailable): the context is lost.
  Result<void> check();

  /// A texture of a format, with undefined texels.
  Texels make_texels(GLenum format, int width, int height);
  /// A target, transparent black.
  Target make_target(GLenum format, int width, int height);
  /// Fills a texture with a picture whose row 0 is at the top; it is made anew if its size differs.
  /// `is_premultiplied`: the shader gets straight alpha.
  void upload(Texels& texels, renderer::View<const std::uint32_t> picture, bool is_premultiplied);
  /// Fills a texture with levels, from its lowest row up, which shaders read as greys.
  void upload_levels(Texels& texels, int width, int height, std::span<const float> levels);
  /// Reads a target of straight alpha as a premultiplied picture with row 0 at the top.
  void read(const Target& target, renderer::Texture& out);
  /// Draws the four corners of the picture into a target with the program in use; `clears`: it is
  /// made transparent black before.
  void draw(const Target& target, bool clears);

  /// The programs that are in use, by their texts.
  using Programs = std::map<std::string, std::weak_ptr<const gl::Program>>;
  Programs& programs() { return programs_; }

  /// One transparent black texel, for images that are not there.
  const Texels& nothing() const { return nothing_; }
  /// The largest side of a texture, px.
  static constexpr int kLargestSide = 8192;

 private:
  explicit Graphics(std::unique_ptr<gl::Context> context);

  std::unique_ptr<gl::Context> context_;
  gl::VertexArray corners_;
  Texels nothing_;
  Programs programs_;
  std::vector<std::uint32_t> scratch_;
};

}  // namespace handcast::content::shader
