// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// The back end that draws on one core of the processor: what every pass of another back end is
/// compared with.
std::unique_ptr<Painter> make_cpu_painter(int width_px, int height_px);

}  // namespace handcast::renderer
