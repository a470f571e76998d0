// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"

/// Takes output frames apart as the projectors' manuals say, without the code that packs them.
namespace handcast::test {

/// Sub-frame `k` of 24x1: 1 where it is lit. Green, red, blue; the lowest bit first (DLPU010).
inline renderer::Image<int> plane_of_24(renderer::View<const std::uint32_t> output, int k) {
  renderer::Image<int> plane(output.width, output.height);
  for (int y = 0; y < output.height; ++y)
    for (int x = 0; x < output.width; ++x) {
      const std::uint32_t red = output.at(x, y) & 0xff, green = output.at(x, y) >> 8 & 0xff,
                          blue = output.at(x, y) >> 16 & 0xff;
      const std::uint32_t channel = k < 8 ? green : k < 16 ? red : blue;
      plane.at(x, y) = channel >> k % 8 & 1;
    }
  return plane;
}

/// Sub-frame `k` of 8x3, as RGBA8 with the levels 0 and 255.
inline renderer::Texture plane_of_8(renderer::View<const std::uint32_t> output, int k) {
  renderer::Texture plane(output.width, output.height);
  for (int y = 0; y < output.height; ++y)
    for (int x = 0; x < output.width; ++x)
      for (const int shift : {0, 8, 16})
        if (output.at(x, y) >> (shift + k) & 1) plane.at(x, y) |= 0xffu << shift;
  return plane;
}

/// Sub-frame `k` of four quadrants: top left, top right, bottom left, bottom right (VPixx, QUAD4X).
inline renderer::Texture quadrant_of(renderer::View<const std::uint32_t> output, int k) {
  renderer::Texture part(output.width / 2, output.height / 2);
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x)
      part.at(x, y) =
          output.at(x + (k % 2 == 1 ? part.width() : 0), y + (k >= 2 ? part.height() : 0));
  return part;
}

/// Sub-frame `k` of twelve: the four quadrants of red, then of green, then of blue (VPixx,
/// QUAD12X).
inline renderer::Image<int> grey_quadrant_of(renderer::View<const std::uint32_t> output, int k) {
  const renderer::Texture part = quadrant_of(output, k % 4);
  renderer::Image<int> grey(part.width(), part.height());
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x)
      grey.at(x, y) = static_cast<int>(part.at(x, y) >> (k < 4 ? 0 : k < 8 ? 8 : 16) & 0xff);
  return grey;
}

}  // namespace handcast::test
