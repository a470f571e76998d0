// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string_view>

#include "renderer/draw/gl/objects.hpp"

namespace handcast::renderer::gl {

/// What the GPU does for one frame, in the order of msg::Stage from gpu_draw on.
enum class Pass { draw, warp, upload, fill, read };
/// The names of the passes.
constexpr std::array<std::string_view, 5> kPassNames{"draw", "warp", "upload", "fill", "read"};

/// The time of each pass on the GPU, in µs; 0 for a pass that was not done.
using PassTimes = std::array<double, kPassNames.size()>;

/// Measures the passes of a frame by timer queries of the GPU.
class PassTimer {
 public:
  /// If it is not `on`, it does nothing.
  PassTimer(Context& context, bool on);

  /// Issues commands as one pass.
  template <class Commands>
  void measure(Pass pass, Commands&& commands) {
    begin(pass);
    commands();
    end(pass);
  }
  /// The passes since the last call. Waits until the GPU has finished them.
  PassTimes take();

 private:
  void begin(Pass pass);
  void end(Pass pass);

  Context& context_;
  std::array<Query, kPassNames.size()> queries_;
  std::array<bool, kPassNames.size()> used_{};
  bool on_;
};

}  // namespace handcast::renderer::gl
