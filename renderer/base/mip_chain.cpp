// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/mip_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/srgb.hpp"

namespace handcast::renderer {
namespace {

/// Red, green and blue in linear light, and alpha; 0..1.
using Light = std::array<float, 4>;

Light in_linear_light(std::uint32_t rgba) {
  static const auto kLight = [] {
    std::array<float, 256> light{};
    for (std::size_t level = 0; level < light.size(); ++level)
      light[level] = static_cast<float>(srgb_light(static_cast<double>(level) / 255));
    return light;
  }();
  return {kLight[rgba & 0xff], kLight[rgba >> 8 & 0xff], kLight[rgba >> 16 & 0xff],
          static_cast<float>(rgba >> 24) / 255};
}

std::uint32_t in_srgb(const Light& light) {
  constexpr int kSteps = 4096;  // a step is 0.8 levels where the curve is steepest
  static const auto kLevel = [] {
    std::array<std::uint8_t, kSteps + 1> levels{};
    for (std::size_t i = 0; i < levels.size(); ++i)
      levels[i] =
          static_cast<std::uint8_t>(std::lround(255 * srgb_level(static_cast<double>(i) / kSteps)));
    return levels;
  }();
  const auto level = [&](int channel) -> std::uint32_t {
    return kLevel[static_cast<std::size_t>(std::lround(kSteps * light[channel]))];
  };
  const auto alpha = static_cast<std::uint32_t>(std::lround(255 * light[3]));
  return level(0) | level(1) << 8 | level(2) << 16 | alpha << 24;
}

/// Half the size, rounded up: the last texel of an odd row is the mean of what there is.
template <class LightAt>
Image<Light> halved(int width, int height, const LightAt& light_at) {
  Image<Light> out((width + 1) / 2, (height + 1) / 2);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int right = std::min(2 * x + 1, width - 1), low = std::min(2 * y + 1, height - 1);
      for (const Light& light : {light_at(2 * x, 2 * y), light_at(right, 2 * y),
                                 light_at(2 * x, low), light_at(right, low)})
        for (std::size_t channel = 0; channel < light.size(); ++channel)
          out.at(x, y)[channel] += light[channel] / 4;
    }
  return out;
}

constexpr int kPad = 1 << MipChain::kMostLevels;

/// Writes a level with its border; `row` is that of its first texel.
template <class TexelAt>
void write_level(int width, int height, int row, Texture& texels, const TexelAt& texel_at) {
  for (int y = -1; y <= height; ++y)
    for (int x = -1; x <= width; ++x)
      texels.at(1 + x, row + y) =
          texel_at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
}

}  // namespace

MipChain::MipChain(const Texture& picture, bool smooth) : smooth_(smooth) {
  constexpr int kMost = 4096;
  if (smooth && std::max(picture.width(), picture.height()) > kMost) {
    const Image<Light> half = halved(picture.width(), picture.height(), [&](int x, int y) {
      return in_linear_light(picture.at(x, y));
    });
    Texture smaller(half.width(), half.height());
    std::transform(half.pixels().begin(), half.pixels().end(), smaller.pixels().begin(), in_srgb);
    *this = MipChain(smaller, smooth);
    return;
  }
  width_ = picture.width();
  height_ = picture.height();
  padded_height_ = (height_ + kPad - 1) / kPad * kPad;
  if (smooth)
    while (levels_ < kMostLevels && std::max(width_, height_) >> levels_ > 0) ++levels_;
  texels_ = Texture(width_ + 2, first_row(levels_ - 1) + (padded_height_ >> (levels_ - 1)) + 1);
  write_level(width_, height_, first_row(0), texels_,
              [&](int x, int y) { return picture.at(x, y); });
  if (levels_ == 1) return;
  Image<Light> level =
      halved(width_, height_, [&](int x, int y) { return in_linear_light(picture.at(x, y)); });
  for (int i = 1; i < levels_; ++i) {
    if (i > 1)
      level = halved(level.width(), level.height(), [&](int x, int y) { return level.at(x, y); });
    write_level(level.width(), level.height(), first_row(i), texels_,
                [&](int x, int y) { return in_srgb(level.at(x, y)); });
  }
}

}  // namespace handcast::renderer
