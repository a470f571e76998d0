// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace handcast::renderer {

/// The luminance of a pixel of sRGB (RGBA8), 0 to kWhiteLuminance; 0 if its alpha is 0. It differs
/// from the light (IEC 61966-2-1) by at most 0.3 % of white, because a sum of a square and a cube
/// replaces the curve of sRGB: 16-bit arithmetic can do that for many pixels at a time. Every grey
/// level from 2 on has more than the one before.
inline std::uint16_t luminance(std::uint32_t rgba) {
  // The share of a channel in the light (ITU-R BT.709) is square / 65536 + 255 cube / 65536.
  const auto channel = [](std::uint32_t level, std::uint16_t square, std::uint16_t cube) {
    const auto squared = static_cast<std::uint16_t>(level * level),
               factor = static_cast<std::uint16_t>(square + cube * level);
    return static_cast<std::uint16_t>(static_cast<std::uint32_t>(squared) * factor >> 16);
  };
  const auto sum = static_cast<std::uint16_t>(channel(rgba & 0xff, 10108, 15) +
                                              channel(rgba >> 8 & 0xff, 33866, 51) +
                                              channel(rgba >> 16 & 0xff, 3457, 5));
  return rgba >> 24 != 0 ? sum : std::uint16_t{0};
}

/// The luminances of `count` pixels.
void luminances(const std::uint32_t* rgba, int count, std::uint16_t* out);

/// luminance() of white.
inline constexpr std::uint16_t kWhiteLuminance = 65024;

}  // namespace handcast::renderer
