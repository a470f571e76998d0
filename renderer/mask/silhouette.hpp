// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// A mask and the image it was made from. Its edge is where the grey value falls through the
/// threshold; where the mask ends for another reason (the cut through the forearm, the image's
/// border) it has none.
struct Silhouette {
  GreyView image;
  std::int64_t origin_ns = 0;  ///< of the image
  GreyView mask;               ///< of the image's size; 255 hand
  Rect region;                 ///< holds all of the mask
  int threshold = 0;

  /// The nearest pixel is hand; none outside the image is.
  bool lit(glm::vec2 at) const {
    const int x = static_cast<int>(std::floor(at.x + 0.5f)),
              y = static_cast<int>(std::floor(at.y + 0.5f));
    return x >= 0 && y >= 0 && x < mask.width && y < mask.height && mask.at(x, y) != 0;
  }

  /// Grey value between the pixels, bilinear; the border goes on beyond the image.
  float grey(glm::vec2 at) const {
    const glm::vec2 held =
        glm::clamp(at, glm::vec2(0), glm::vec2(image.width - 1, image.height - 1));
    const int x = std::min(static_cast<int>(held.x), image.width - 2),
              y = std::min(static_cast<int>(held.y), image.height - 2);
    const float u = held.x - static_cast<float>(x), v = held.y - static_cast<float>(y);
    const std::uint8_t *top = image.row(y) + x, *bottom = image.row(y + 1) + x;
    const float above = (1 - u) * top[0] + u * top[1], below = (1 - u) * bottom[0] + u * bottom[1];
    return (1 - v) * above + v * below;
  }
};

}  // namespace handcast::renderer
