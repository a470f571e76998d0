// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "config/sections/projector.hpp"
#include "ipc/base/clock.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// How long a painter takes for a frame, with its image in the processor's memory.
struct FrameTime {
  /// The median, and the 99th percentile.
  /// @{
  double p50_ms = 0, p99_ms = 0;
  /// @}
};

/// When a contest of painters ends.
struct ContestEnd {
  /// As soon as the same painter was faster by this factor in `clear_rounds` rounds in succession.
  /// @{
  double clear_factor = 1.5;
  int clear_rounds = 3;
  /// @}
  double limit_s = 0.3;  ///< and at the latest after this time, as soon as both have drawn
};

/// Draws and fills the same frames with two painters in turn: a closed surface with about as many
/// triangles and lit pixels as a hand at its usual distance, and a mask that is a few pixels off. A
/// round is a few frames of each painter; its first one warms up and is not counted. `clock`: ns,
/// for tests.
std::pair<FrameTime, FrameTime> contest(Painter& one, Painter& other, int width_px, int height_px,
                                        const ContestEnd& end = {},
                                        const std::function<std::int64_t()>& clock = now_ns);

/// Opens the painter that the settings ask for, for images of this size. It logs what draws, and
/// for `auto` what it measured. A painter gl that cannot be opened is replaced by cpu with a
/// warning. `shares`: where the output finds images of a GPU; a painter that cannot share with it
/// reads its images back. `threads`: of a painter cpu.
std::unique_ptr<Painter> open_painter(config::PainterChoice choice, int width_px, int height_px,
                                      const ShareGroup& shares = {}, int threads = 1);

}  // namespace handcast::renderer
