// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"
#include "renderer/draw/gl/objects.hpp"

namespace handcast::renderer::gl {

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

}  // namespace handcast::renderer::gl
