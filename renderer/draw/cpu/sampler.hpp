// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "renderer/base/mip_chain.hpp"

namespace handcast::renderer::cpu {

/// The alpha of an opaque colour.
constexpr std::uint32_t kOpaque = 0xff000000;

/// Red, green and blue of a colour times `factor` / 256 (0..256); alpha 0.
[[gnu::always_inline]] inline std::uint32_t dimmed(std::uint32_t colour, std::uint32_t factor) {
  const std::uint32_t red_blue = ((colour & 0xff00ff) * factor >> 8) & 0xff00ff;
  const std::uint32_t green = ((colour & 0x00ff00) * factor >> 8) & 0x00ff00;
  return red_blue | green;
}

/// Where a picture is read: a texel, and for a filtered one how far the next column and row weigh.
struct Footprint {
  std::int32_t index;  ///< of the upper left texel
  /// Weights of the right and the lower texels, 0..255 of 256.
  /// @{
  std::int32_t right, down;
  /// @}
};

/// The mean of the texels of a footprint by their weights; alpha 0. `upper`, `lower`: the two of a
/// row, the left one in the lower half. The light of a level is taken as its square, which is near
/// to sRGB: the mean of black and white is 180 instead of 188.
[[gnu::always_inline]] inline std::uint32_t mean_of(std::uint64_t upper, std::uint64_t lower,
                                                    const Footprint& place) {
  const std::int32_t both = place.right * place.down >> 8;
  const auto upper_left = static_cast<float>(256 - place.right - place.down + both),
             upper_right = static_cast<float>(place.right - both),
             lower_left = static_cast<float>(place.down - both),
             lower_right = static_cast<float>(both);
  const auto a = static_cast<std::uint32_t>(upper), b = static_cast<std::uint32_t>(upper >> 32),
             c = static_cast<std::uint32_t>(lower), d = static_cast<std::uint32_t>(lower >> 32);
  const auto mean = [&](int shift) {
    const auto square = [shift](std::uint32_t texel) {
      const auto level = static_cast<float>(static_cast<std::int32_t>(texel >> shift & 0xff));
      return level * level;
    };
    const float squares = upper_left * square(a) + upper_right * square(b) +
                          lower_left * square(c) + lower_right * square(d);
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): lround is no vector instruction
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::sqrt(squares) / 16 + 0.5f));
  };
  return mean(0) | mean(8) << 8 | mean(16) << 16;
}

/// Several footprints, and the texels found there.
struct Lookup {
  static constexpr int kCount = 16;
  alignas(64) std::int32_t index[kCount], right[kCount], down[kCount];
  alignas(64) std::uint64_t upper[kCount], lower[kCount];

  Footprint place(int i) const { return {index[i], right[i], down[i]}; }
};

/// Reads a mip chain. Texture coordinates outside 0..1 are clamped; NaN is taken as 0.
struct Sampler {
  /// Borrows the chain; nullptr: white.
  explicit Sampler(const MipChain* picture) {
    static const MipChain kWhite;
    if (picture == nullptr) picture = &kWhite;
    texels = picture->texels().data;
    stride = picture->texels().stride;
    width = static_cast<float>(picture->width());
    height = static_cast<float>(picture->height());
    padded_height = picture->padded_height();
    last_level = picture->levels() - 1;
    smooth = picture->smooth();
  }

  /// The index of the texel of level 0 at texture coordinates (u, v).
  [[gnu::always_inline]] std::int32_t nearest(float u, float v) const {
    const auto column = static_cast<std::int32_t>(std::min(std::max(0.f, u * width), width - 1));
    const auto line = static_cast<std::int32_t>(std::min(std::max(0.f, v * height), height - 1));
    return (line + 1) * stride + column + 1;
  }

  /// The four texels of `level` around texture coordinates (u, v).
  [[gnu::always_inline]] Footprint around(float u, float v, std::int32_t level) const {
    constexpr int kOne = 1 << MipChain::kMostLevels;
    const float scale = static_cast<float>(kOne >> level) / kOne;
    // 0.5 is the centre of the border, and the level begins at 1.
    const float columns = width * scale, rows = height * scale;
    const float x = std::min(std::max(0.f, u * columns), columns) + 0.5f,
                y = std::min(std::max(0.f, v * rows), rows) + 0.5f;
    const auto right = static_cast<std::int32_t>(256 * x),
               down = static_cast<std::int32_t>(256 * y);
    const std::int32_t first_row = 2 * level + 2 * (padded_height - (padded_height >> level));
    return {(first_row + (down >> 8)) * stride + (right >> 8), right & 255, down & 255};
  }

  /// Reads the texels of footprint `i`: four if kSmooth, otherwise one.
  template <bool kSmooth>
  [[gnu::always_inline]] void read(Lookup& at, int i) const {
    if constexpr (kSmooth) {
      std::memcpy(&at.upper[i], texels + at.index[i], sizeof at.upper[i]);
      std::memcpy(&at.lower[i], texels + at.index[i] + stride, sizeof at.lower[i]);
    } else {
      at.upper[i] = texels[at.index[i]];
    }
  }

  const std::uint32_t* texels;  ///< of all levels, RGBA8
  std::int32_t stride;          ///< texels from one row to the next
  /// Size of the picture in texels.
  /// @{
  float width, height;
  /// @}
  std::int32_t padded_height, last_level;  ///< see MipChain
  bool smooth;                             ///< see MipChain::smooth()
};

}  // namespace handcast::renderer::cpu
