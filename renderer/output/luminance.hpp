// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstring>

namespace handcast::renderer {

/// The light of a channel 0..255 whose share in the light (ITU-R BT.709) is square / 65536 + 255
/// cube / 65536.
inline std::uint16_t light_of_channel(std::uint16_t level, std::uint16_t square,
                                      std::uint16_t cube) {
  const auto squared = static_cast<std::uint16_t>(level * level),
             factor = static_cast<std::uint16_t>(square + cube * level);
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(squared) * factor >> 16);
}

/// The luminance of a pixel of sRGB (RGBA8), 0 to kWhiteLuminance; 0 if its alpha is 0. It differs
/// from the light (IEC 61966-2-1) by at most 0.3 % of white, because a sum of a square and a cube
/// replaces the curve of sRGB: 16-bit arithmetic can do that for many pixels at a time. Every grey
/// level from 2 on has more than the one before.
inline std::uint16_t luminance(std::uint32_t rgba) {
  const auto level = [rgba](int shift) { return static_cast<std::uint16_t>(rgba >> shift & 0xff); };
  const auto sum = static_cast<std::uint16_t>(light_of_channel(level(0), 10108, 15) +
                                              light_of_channel(level(8), 33866, 51) +
                                              light_of_channel(level(16), 3457, 5));
  return rgba >> 24 != 0 ? sum : std::uint16_t{0};
}

/// The factors of two channels that stand in one word, for kPixels pixels.
template <int kPixels>
struct ChannelPairs {
  constexpr ChannelPairs(std::uint16_t low, std::uint16_t high) {
    for (int i = 0; i < kPixels; ++i) {
      of[2 * i] = low;
      of[2 * i + 1] = high;
    }
  }
  std::uint16_t of[2 * kPixels] = {};
};

/// luminance() of kPixels pixels. Two channels of a pixel stand in one word, so that 16-bit vectors
/// need no rearrangement between the pixels and their luminances.
template <int kPixels>
[[gnu::always_inline]] inline void luminances(const std::uint32_t* rgba, std::uint32_t* out) {
  using Pairs = ChannelPairs<kPixels>;
  static constexpr Pairs kSquare(10108, 3457), kCube(15, 5);         // red and blue
  static constexpr Pairs kGreenSquare(33866, 0), kGreenCube(51, 0);  // green and alpha
  std::uint32_t red_blue[kPixels], green_alpha[kPixels];
  for (int i = 0; i < kPixels; ++i) red_blue[i] = rgba[i] & 0x00ff00ffu;
  for (int i = 0; i < kPixels; ++i) green_alpha[i] = rgba[i] >> 8 & 0x00ff00ffu;
  std::uint16_t light[2 * kPixels], green[2 * kPixels];
  std::memcpy(light, red_blue, sizeof light);
  std::memcpy(green, green_alpha, sizeof green);
  for (int i = 0; i < 2 * kPixels; ++i)
    light[i] = static_cast<std::uint16_t>(
        light_of_channel(light[i], kSquare.of[i], kCube.of[i]) +
        light_of_channel(green[i], kGreenSquare.of[i], kGreenCube.of[i]));
  std::memcpy(red_blue, light, sizeof light);
  for (int i = 0; i < kPixels; ++i) {
    const std::uint32_t sum = (red_blue[i] + (red_blue[i] >> 16)) & 0xffff;
    out[i] = rgba[i] >> 24 != 0 ? sum : 0;
  }
}

/// luminance() of white.
inline constexpr std::uint16_t kWhiteLuminance = 65024;

}  // namespace handcast::renderer
