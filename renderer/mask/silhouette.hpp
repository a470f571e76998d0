// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/base/image.hpp"
#include "renderer/mask/local_threshold.hpp"

namespace handcast::renderer {

/// A mask and the image it was made from, both borrowed. The edge of the silhouette is where the
/// grey value falls below the threshold. There is no edge where the mask ends for another reason
/// (the cut at the forearm, the border of the image).
struct Silhouette {
  GreyView image;                         ///< the camera's image
  std::int64_t origin_ns = 0;             ///< middle of its exposure
  GreyView mask;                          ///< of the size of the image; 255 hand, 0 not
  Rect region;                            ///< contains all hand pixels of the mask
  int threshold = 0;                      ///< pixels above it are bright
  const LocalThreshold* local = nullptr;  ///< if set, its thresholds count instead of the one above

  /// The grey value of the edge near a pixel of the region.
  float edge_at(glm::ivec2 pixel) const {
    return (local ? std::floor(local->at(pixel.x, pixel.y)) : static_cast<float>(threshold)) + 0.5f;
  }

  /// True if the pixel nearest to `at` (image px) is hand. False outside the image.
  bool lit(glm::vec2 at) const {
    const int x = static_cast<int>(std::floor(at.x + 0.5f)),
              y = static_cast<int>(std::floor(at.y + 0.5f));
    return x >= 0 && y >= 0 && x < mask.width && y < mask.height && mask.at(x, y) != 0;
  }

  /// Grey value at `at` (image px), bilinear between the pixels; clamped to the image.
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
