// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::landmarks {

/// The largest factor of BoxFilter::shrink().
inline constexpr int kMostFactor = 64;

/// Shrinks a part of an image: each new pixel is the rounded mean of factor x factor old ones.
/// Keeps its buffers between images. One thread.
class BoxFilter {
 public:
  /// Shrinks `rect`, which must lie in the image, by `factor` (2..kMostFactor). Columns and rows at
  /// its right and lower edge that do not fill a whole pixel are dropped. The result is valid until
  /// the next call; it is empty if `rect` is smaller than one new pixel.
  renderer::GreyView shrink(renderer::GreyView image, const renderer::Rect& rect, int factor);

 private:
  std::vector<std::uint16_t> sums_;
  std::vector<std::uint8_t> small_;
};

}  // namespace handcast::landmarks
