// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::landmarks {

inline constexpr int kMostFactor = 64;

/// A part of an image made smaller, each pixel the rounded mean of factor x factor. Keeps its
/// buffers. One thread.
class BoxFilter {
 public:
  /// `rect` lies in the image; what is left over at its right and lower edge is left out.
  /// `factor`: 2..kMostFactor. The result is valid until the next call, and without pixels where
  /// the part is too small for one.
  renderer::GreyView shrink(renderer::GreyView image, const renderer::Rect& rect, int factor);

 private:
  std::vector<std::uint16_t> sums_;
  std::vector<std::uint8_t> small_;
};

}  // namespace handcast::landmarks
