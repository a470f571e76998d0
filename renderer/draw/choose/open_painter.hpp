// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "config/sections/projector.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::renderer {

/// Opens the painter that the settings ask for, for images of this size. It logs what draws, and
/// for `auto` what it measured. A painter gl that cannot be opened is replaced by cpu with a
/// warning. `shares`: where the output finds images of a GPU; a painter that cannot share with it
/// reads its images back.
std::unique_ptr<Painter> open_painter(config::PainterChoice choice, int width_px, int height_px,
                                      const ShareGroup& shares = {});

}  // namespace handcast::renderer
