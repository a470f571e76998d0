// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// How long a painter takes for a frame, with its image in the processor's memory.
struct FrameTime {
  /// The median, and the 99th percentile.
  /// @{
  double p50_ms = 0, p99_ms = 0;
  /// @}
};

/// Draws and fills the same frames with two painters in turn, for `seconds` in total: a closed
/// surface with about as many triangles and lit pixels as a hand at its usual distance, and a mask
/// that is a few pixels off.
std::pair<FrameTime, FrameTime> contest(Painter& one, Painter& other, int width_px, int height_px,
                                        double seconds);

}  // namespace handcast::renderer
