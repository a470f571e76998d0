// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// The back end that draws on the processor: the reference for the passes of all others. With more
/// than one thread, the pixels are the same, and the others sleep but for the step draw.
std::unique_ptr<Painter> make_cpu_painter(int width_px, int height_px, int threads = 1);

}  // namespace handcast::renderer
