// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <utility>

#include "config/sections/projector.hpp"
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

/// Opens the painter that the settings ask for, for images of this size. It logs what draws, and
/// for `auto` what it measured. A painter gl that cannot be opened is replaced by cpu with a
/// warning. `shares`: where the output finds images of a GPU; a painter that cannot share with it
/// reads its images back.
std::unique_ptr<Painter> open_painter(config::PainterChoice choice, int width_px, int height_px,
                                      const ShareGroup& shares = {});

}  // namespace handcast::renderer
