// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace handcast::gallery {

inline constexpr std::uint32_t kNight = 0xff0a0807;  ///< what is behind the hands, RGBA8

/// Skin under the dim light of a room and the light of the projector, RGBA8. `lambert`: the share
/// of the light that its direction and its own darkness leave, 0..255; `light`: RGBA8.
inline std::uint32_t lit_skin(std::uint32_t lambert, std::uint32_t light) {
  constexpr std::array<float, 3> kSkin{0.88f, 0.72f, 0.62f};  // albedo
  constexpr float kRoomLight = 0.13f;                         // relative to the projector's white
  std::uint32_t pixel = 0xff000000u;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const float shade = static_cast<float>(lambert) / 255,
                level = static_cast<float>(light >> (8 * channel) & 0xff);
    const float value = kSkin[channel] * (kRoomLight * 255 * shade + level * std::sqrt(shade));
    pixel |= static_cast<std::uint32_t>(std::clamp(value, 0.f, 255.f)) << (8 * channel);
  }
  return pixel;
}

}  // namespace handcast::gallery
