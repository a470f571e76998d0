// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// The back end that draws on one core of the processor: the reference for the passes of all
/// others.
std::unique_ptr<Painter> make_cpu_painter(int width_px, int height_px);

}  // namespace handcast::renderer
