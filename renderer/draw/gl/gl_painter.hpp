// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "ipc/base/result.hpp"
#include "renderer/draw/gl/context.hpp"
#include "renderer/draw/gl/objects.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// The back end that draws with OpenGL 4.5, on a GPU or a software renderer, without a window. It
/// has a context of its own, which its calls make current on their thread.
class GlPainter : public Painter {
 public:
  /// What draws.
  virtual const gl::Gpu& gpu() const = 0;
  /// Times of the passes since the last call; all 0 if the painter was opened without timers.
  virtual gl::PassTimes pass_times() = 0;
};

/// How a GlPainter works.
struct GlOptions {
  bool is_timed = false;  ///< measure passes, see GlPainter::pass_times()
  /// fill() also copies the image for colour(), so that both wait for the GPU only once.
  bool reads_back = true;
  /// The share group of the output, for Painter::device_image(); fill() does not copy the image
  /// then.
  ShareGroup shares;
};

/// Opens a painter for images of this size. Errors (unavailable): those of Context::open(), a
/// shader that the driver refuses, no memory on the GPU.
Result<std::unique_ptr<GlPainter>> open_gl_painter(int width_px, int height_px,
                                                   const GlOptions& options = {});

}  // namespace handcast::renderer
