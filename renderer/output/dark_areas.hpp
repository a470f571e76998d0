// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "config/keep_out.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Rectangles that cover these areas (even-odd rule) in an image of this size, and each pixel that
/// they touch in a row through its middle. None overlaps another of the same area.
std::vector<Rect> dark_areas(std::span<const config::Polygon> areas, int width_px, int height_px);

}  // namespace handcast::renderer
