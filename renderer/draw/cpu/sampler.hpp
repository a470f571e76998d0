// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>

#include "renderer/base/mip_chain.hpp"
#include "renderer/draw/cpu/raster.hpp"

/// @file
/// Reads mip chains, 16 places at once. What is called in loops is inlined into functions that are
/// compiled for several instruction sets.

namespace handcast::renderer::cpu {

/// The alpha of an opaque colour.
constexpr std::uint32_t kOpaque = 0xff000000;

/// A mip chain, borrowed. Places are those of TexelMap.
class Sampler {
 public:
  /// Without texels: white. `uv`: where it will be read, but for steps beyond.
  explicit Sampler(MipView picture, std::span<const glm::vec2> uv = {}) {
    static const MipChain kWhite;
    if (picture.texels == nullptr) picture = kWhite.view();
    const msg::MipLayout& layout = picture.layout;
    texels = picture.texels;
    stride = layout.stride();
    fraction = layout.smooth ? 255 : 0;
    size = static_cast<float>(layout.width) * static_cast<float>(layout.height);
    levels_ = layout.levels();
    for (int level = 0; level < levels_; ++level) maps_[level] = map_of(layout, level);
    bool is_inside = true;
    for (const glm::vec2 at : uv)
      is_inside &= (at.x >= 0) & (at.x <= 1) & (at.y >= 0) & (at.y <= 1);
    leaves_picture = !is_inside;
  }

  /// Where texture coordinates lie in each level.
  std::span<const TexelMap> maps() const { return std::span(maps_).first(levels_); }
  const std::uint32_t* texels;  ///< of all levels, RGBA8
  std::int32_t stride;          ///< texels from one row to the next
  float size;                   ///< texels of level 0
  /// The bits of a place that are within a texel: 255, or 0 if the nearest texel is read.
  std::int32_t fraction;
  bool leaves_picture;  ///< texture coordinates are not all in 0..1

 private:
  /// The border of a chain is one texel wide. Smooth: the texel to the left of a place and above it
  /// is the first of the four that it is between; otherwise it is the nearest.
  static TexelMap map_of(const msg::MipLayout& picture, int level) {
    constexpr float kOne = 256;  // of a texel
    const float scale = std::ldexp(1.f, -level), border = picture.smooth ? 0.5f : 1;
    const auto first_row = static_cast<float>(picture.first_row(level) - 1);
    const glm::vec2 texels = kOne * scale * glm::vec2(picture.width, picture.height);
    return {texels, kOne * glm::vec2(border, border + first_row), 1.f / texels};
  }

  std::array<TexelMap, msg::MipLayout::kMostLevels> maps_;
  int levels_;
};

/// 16 places in pictures, and the texels found there.
struct Lookup {
  static constexpr int kCount = 16;
  alignas(64) std::int32_t index[kCount];  ///< of the upper left texel
  /// Weights of the right and the lower texels, 0..255 of 256.
  /// @{
  alignas(64) std::uint32_t right[kCount], down[kCount];
  /// @}
  /// The two texels of a row, the left one in the lower half.
  /// @{
  alignas(64) std::uint64_t upper[kCount], lower[kCount];
  /// @}

  /// Sets place `i` (s, t).
  [[gnu::always_inline]] void set(int i, float s, float t, std::int32_t stride,
                                  std::int32_t fraction) {
    const auto column = static_cast<std::int32_t>(s), row = static_cast<std::int32_t>(t);
    // Unsigned: a lane that shows nothing may hold any number.
    index[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(row >> 8) *
                                             static_cast<std::uint32_t>(stride) +
                                         static_cast<std::uint32_t>(column >> 8));
    right[i] = static_cast<std::uint32_t>(column & fraction);
    down[i] = static_cast<std::uint32_t>(row & fraction);
  }
  /// Reads the four texels of place `i`.
  [[gnu::always_inline]] void read(int i, const std::uint32_t* texels, std::int32_t stride) {
    const std::uint32_t* const first = texels + index[i];
    std::memcpy(&upper[i], first, sizeof upper[i]);
    std::memcpy(&lower[i], first + stride, sizeof lower[i]);
  }
};

/// Two numbers of 16 bits in each of 16 lanes.
union alignas(64) HalfLanes {
  std::uint32_t lane[Lookup::kCount];
  std::uint16_t half[2 * Lookup::kCount];
};

/// Adds level * (level + 1) of two channels of 16 texels, weighted by 1/65,536. It is nearly the
/// square, but does not vanish when it is rounded down.
[[gnu::always_inline]] inline void add_squares(const std::uint64_t* texels, int shift,
                                               const HalfLanes& weights, HalfLanes& sums) {
  HalfLanes levels;
#pragma GCC unroll 1
  for (int i = 0; i < Lookup::kCount; ++i)
    levels.lane[i] = static_cast<std::uint32_t>(texels[i] >> shift) & 0xff00ff;
#pragma GCC unroll 1
  for (int i = 0; i < 2 * Lookup::kCount; ++i) {
    const auto square =
        static_cast<std::uint16_t>(levels.half[i] * levels.half[i] + levels.half[i]);
    sums.half[i] =
        static_cast<std::uint16_t>(sums.half[i] + (std::uint32_t{square} * weights.half[i] >> 16));
  }
}

/// The means of the texels of all places by their weights, times `factor` (0..1); alpha 0. The
/// light of a level is taken as its square, which is near to sRGB: the mean of black and white is
/// 180 instead of 188.
[[gnu::always_inline]] inline void mix(const Lookup& at, const float* __restrict factor,
                                       std::uint32_t* __restrict colour) {
  // The weights of both halves of a lane, of 65,280: 256 times 255, so that all of it fits.
  constexpr std::uint32_t kBoth = 0x00ff00ff;
  constexpr float kAll = 65'536.f / 65'280, kLost = 0.7f;  // in the mean, by rounding down
  HalfLanes upper_left, upper_right, lower_left, lower_right, red_blue{}, green{};
#pragma GCC unroll 1
  for (int i = 0; i < Lookup::kCount; ++i) {
    const std::uint32_t right = at.right[i], down = at.down[i], both = right * down >> 8;
    upper_left.lane[i] = (256 - right - down + both) * kBoth;
    upper_right.lane[i] = (right - both) * kBoth;
    lower_left.lane[i] = (down - both) * kBoth;
    lower_right.lane[i] = both * kBoth;
  }
  add_squares(at.upper, 0, upper_left, red_blue);
  add_squares(at.upper, 8, upper_left, green);
  add_squares(at.upper, 32, upper_right, red_blue);
  add_squares(at.upper, 40, upper_right, green);
  add_squares(at.lower, 0, lower_left, red_blue);
  add_squares(at.lower, 8, lower_left, green);
  add_squares(at.lower, 32, lower_right, red_blue);
  add_squares(at.lower, 40, lower_right, green);
#pragma GCC unroll 1
  for (int i = 0; i < Lookup::kCount; ++i) {
    const float half = 0.5f - 0.5f * factor[i];  // rounds, and solves level * (level + 1)
    const auto level = [&](std::uint32_t sum) {
      const float root =
          std::sqrt(static_cast<float>(static_cast<std::int32_t>(sum)) * kAll + (0.25f + kLost));
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(root * factor[i] + half));
    };
    colour[i] = level(red_blue.lane[i] & 0xffff) | level(green.lane[i] & 0xffff) << 8 |
                level(red_blue.lane[i] >> 16) << 16;
  }
}

}  // namespace handcast::renderer::cpu
