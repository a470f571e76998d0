// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Copies pictures to the back buffer of the current context of OpenGL. Used and destroyed while
/// its context is current.
class Blit {
 public:
  Blit();
  ~Blit();
  Blit(const Blit&) = delete;
  Blit& operator=(const Blit&) = delete;

  /// Draws the region of a picture (RGBA8), scaled from the whole picture to the whole buffer of
  /// `to_width_px` x `to_height_px`; black elsewhere.
  void draw(View<const std::uint32_t> picture, Rect region, int to_width_px, int to_height_px);
  /// Waits until the context has done all of it.
  void finish();

 private:
  void upload(View<const std::uint32_t> picture, const Rect& region);

  unsigned texture_ = 0, framebuffer_ = 0;
  int width_px_ = 0, height_px_ = 0;  ///< of the texture
};

}  // namespace handcast::renderer
