// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "config/sections/projector.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// The levels that the projector is given for the levels 0..255 of a picture. Pictures are encoded
/// as in sRGB (IEC 61966-2-1). 0 stays 0, and no level gets a smaller one than the level before.
using LightTable = std::array<std::uint8_t, 256>;

/// The table for a projector with the settings `gamma` and `brightness`. The brightness is a factor
/// of the light, not of the levels, and is multiplied by `fade` (0 dark to 1).
LightTable light_table(const config::Projector& settings, double fade = 1);

/// The light 0..1 that the levels 0..255 of a picture stand for at full brightness.
std::array<float, 256> light_of_levels();

/// Copies the region of a frame to `out`, which has the same size: its levels by the table, alpha
/// 255; black where the alpha of the frame is 0. `region` is clipped to the image.
void write_light(View<const std::uint32_t> frame, Rect region, const LightTable& table,
                 View<std::uint32_t> out);

}  // namespace handcast::renderer
