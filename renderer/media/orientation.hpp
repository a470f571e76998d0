// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// The image as it is to be seen. `orientation`: 1..8, where the first row and the first column
/// belong (Exif 2.3, 4.6.4); 1: as they are.
template <class Pixel>
Image<Pixel> turned(Image<Pixel> image, int orientation) {
  if (orientation == 1) return image;
  const auto is_one_of = [&](int a, int b, int c, int d) {
    return orientation == a || orientation == b || orientation == c || orientation == d;
  };
  const bool swaps = is_one_of(5, 6, 7, 8), from_right = is_one_of(2, 3, 7, 8),
             from_below = is_one_of(3, 4, 6, 7);
  const int width = image.width(), height = image.height();
  Image<Pixel> out(swaps ? height : width, swaps ? width : height);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int column = swaps ? y : x, row = swaps ? x : y;
      out.at(x, y) =
          image.at(from_right ? width - 1 - column : column, from_below ? height - 1 - row : row);
    }
  return out;
}

}  // namespace handcast::renderer
