// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"
#include "renderer/draw/gl/program.hpp"

namespace handcast::bench {

/// Jump flooding (Rong and Tan 2006) by fragment shaders, only to compare its cost with that of the
/// painter's exact search. It has a context of its own.
class JumpFlood {
 public:
  /// `seeds`: pixels that are not 0.
  static Result<JumpFlood> create(renderer::View<const std::uint8_t> seeds);

  /// Does passes over `region` with steps 2^(passes - 1) … 2, 1, and waits for them. `leads`: a
  /// pass with step 1 comes before them.
  void flood(const renderer::Rect& region, int passes, bool leads);

 private:
  JumpFlood() = default;

  std::unique_ptr<renderer::gl::Context> context_;
  renderer::gl::Program program_;
  renderer::gl::VertexArray nothing_;
  renderer::gl::Image2d nearest_[2];
  renderer::gl::Framebuffer targets_[2];
};

}  // namespace handcast::bench
