// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"
#include "renderer/draw/gl/layers.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::renderer::gl {

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
