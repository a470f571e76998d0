// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/mip_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/srgb.hpp"

namespace handcast::renderer {
namespace {

/// Red, green and blue in linear light, and alpha; 0..kFull.
using Light = std::array<std::uint16_t, 4>;
constexpr int kFull = 65'535;

/// The light of a level of 255.
const std::array<std::uint16_t, 256> kLight = [] {
  std::array<std::uint16_t, 256> light{};
  for (std::size_t level = 0; level < light.size(); ++level)
    light[level] = static_cast<std::uint16_t>(
        std::lround(kFull * srgb_light(static_cast<double>(level) / 255)));
  return light;
}();

/// The level of a light, by its upper 12 bits: a step is 0.8 levels where the curve is steepest.
constexpr int kSteps = 4096;
const std::array<std::uint8_t, kSteps + 1> kLevel = [] {
  std::array<std::uint8_t, kSteps + 1> levels{};
  for (std::size_t i = 0; i < levels.size(); ++i)
    levels[i] =
        static_cast<std::uint8_t>(std::lround(255 * srgb_level(static_cast<double>(i) / kSteps)));
  return levels;
}();

Light in_linear_light(std::uint32_t rgba) {
  return {kLight[rgba & 0xff], kLight[rgba >> 8 & 0xff], kLight[rgba >> 16 & 0xff],
          static_cast<std::uint16_t>((rgba >> 24) * 257)};
}

std::uint32_t in_srgb(const Light& light) {
  const auto level = [&](int channel) -> std::uint32_t {
    return kLevel[(light[channel] + 8u) >> 4];
  };
  const std::uint32_t alpha = (light[3] + 128u) / 257;
  return level(0) | level(1) << 8 | level(2) << 16 | alpha << 24;
}

/// Half the size, rounded up: the last texel of an odd row is the mean of what there is.
template <class LightAt>
Image<Light> halved(int width, int height, const LightAt& light_at) {
  Image<Light> out((width + 1) / 2, (height + 1) / 2);
  for (int y = 0; y < out.height(); ++y) {
    const int up = 2 * y, low = std::min(up + 1, height - 1);
    for (int x = 0; x < out.width(); ++x) {
      const int left = 2 * x, right = std::min(left + 1, width - 1);
      const Light a = light_at(left, up), b = light_at(right, up), c = light_at(left, low),
                  d = light_at(right, low);
      for (std::size_t channel = 0; channel < a.size(); ++channel)
        out.at(x, y)[channel] =
            static_cast<std::uint16_t>((a[channel] + b[channel] + c[channel] + d[channel] + 2) / 4);
    }
  }
  return out;
}

Image<Light> halved(View<const std::uint32_t> picture) {
  return halved(picture.width, picture.height,
                [&](int x, int y) { return in_linear_light(picture.at(x, y)); });
}

Image<Light> halved(const Image<Light>& level) {
  return halved(level.width(), level.height(), [&](int x, int y) { return level.at(x, y); });
}

/// Writes a level with its border. `texels`: the image of all levels, `row`: that of its first
/// texel.
template <class TexelAt>
void write_level(int width, int height, int row, View<std::uint32_t> texels,
                 const TexelAt& texel_at) {
  for (int y = 0; y < height; ++y) {
    std::uint32_t* const out = texels.row(row + y) + 1;
    for (int x = 0; x < width; ++x) out[x] = texel_at(x, y);
    out[-1] = out[0];
    out[width] = out[width - 1];
  }
  std::copy_n(texels.row(row), width + 2, texels.row(row - 1));
  std::copy_n(texels.row(row + height - 1), width + 2, texels.row(row + height));
}

}  // namespace

void write_mips(View<const std::uint32_t> picture, const msg::MipLayout& layout,
                std::uint32_t* texels) {
  const View<std::uint32_t> all{texels, layout.stride(), layout.rows(), layout.stride()};
  write_level(layout.width, layout.height, layout.first_row(0), all,
              [&](int x, int y) { return picture.at(x, y); });
  const int levels = layout.levels();
  if (levels == 1) return;
  Image<Light> level = halved(picture);
  for (int i = 1; i < levels; ++i) {
    if (i > 1) level = halved(level);
    write_level(level.width(), level.height(), layout.first_row(i), all,
                [&](int x, int y) { return in_srgb(level.at(x, y)); });
  }
}

MipChain::MipChain(const Texture& picture, bool smooth)
    : layout_{picture.width(), picture.height(), smooth} {
  constexpr int kMost = 4096;
  if (smooth && std::max(picture.width(), picture.height()) > kMost) {
    const Image<Light> half = halved(picture.view());
    Texture smaller(half.width(), half.height());
    std::transform(half.pixels().begin(), half.pixels().end(), smaller.pixels().begin(), in_srgb);
    *this = MipChain(smaller, smooth);
    return;
  }
  texels_ = Texture(layout_.stride(), layout_.rows());
  write_mips(picture.view(), layout_, texels_.row(0));
}

}  // namespace handcast::renderer
