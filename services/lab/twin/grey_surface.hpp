// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "renderer/base/image.hpp"
#include "services/lab/twin/surface.hpp"

namespace handcast::twin {

/// Pixels that the rows of draw_grey()'s images have behind the region.
inline constexpr int kSpare_px = 8;

/// Draws the triangles that face the viewer like draw_triangle(), with the grey values of their
/// corners interpolated, several pixels at a time. `grey`: by vertex. The rows of both images are
/// kSpare_px longer than the region; what is there keeps its value.
void draw_grey(const ScreenVertices& v, std::span<const float> grey,
               std::span<const std::array<std::uint16_t, 3>> triangles, float front,
               const renderer::Rect& region, renderer::View<float> inverse_depth,
               renderer::View<float> image);

}  // namespace handcast::twin
