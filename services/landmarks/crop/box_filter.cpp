// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/crop/box_filter.hpp"

#include "renderer/base/clones.hpp"

namespace handcast::landmarks {
namespace {

using renderer::GreyView;
using renderer::Rect;

HANDCAST_CLONES void sum_rows(const std::uint8_t* first, int stride, int rows, std::uint16_t* sums,
                              int count) {
  for (int i = 0; i < count; ++i) sums[i] = first[i];
  for (int k = 1; k < rows; ++k) {
    const std::uint8_t* row = first + static_cast<std::ptrdiff_t>(k) * stride;
    for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + row[i]);
  }
}

/// Exact: (sum + half + 0.5) / area is at least 0.5 / area away from a whole number, which is more
/// than the rounding error of the product.
inline std::uint8_t rounded_mean(int sum, int area, float inverse) {
  const int half = area / 2;
  return static_cast<std::uint8_t>(
      static_cast<int>((static_cast<float>(sum + half) + 0.5f) * inverse));
}

template <int factor>
inline void mean_columns(const std::uint16_t* sums, std::uint8_t* out, int count) {
  constexpr int kArea = factor * factor;
  for (int x = 0; x < count; ++x) {
    int sum = 0;
    for (int k = 0; k < factor; ++k) sum += sums[x * factor + k];
    out[x] = rounded_mean(sum, kArea, 1.0f / kArea);
  }
}

inline void mean_columns_of_any(const std::uint16_t* sums, int factor, std::uint8_t* out,
                                int count) {
  const int area = factor * factor;
  for (int x = 0; x < count; ++x) {
    int sum = 0;
    for (int k = 0; k < factor; ++k) sum += sums[x * factor + k];
    out[x] = rounded_mean(sum, area, 1.0f / static_cast<float>(area));
  }
}

HANDCAST_CLONES void mean_columns(const std::uint16_t* __restrict sums, int factor,
                                  std::uint8_t* __restrict out, int count) {
  switch (factor) {
    case 2:
      return mean_columns<2>(sums, out, count);
    case 3:
      return mean_columns<3>(sums, out, count);
    case 4:
      return mean_columns<4>(sums, out, count);
    case 5:
      return mean_columns<5>(sums, out, count);
    case 6:
      return mean_columns<6>(sums, out, count);
    default:
      return mean_columns_of_any(sums, factor, out, count);
  }
}

}  // namespace

GreyView BoxFilter::shrink(GreyView image, const Rect& rect, int factor) {
  const int width = rect.width() / factor, height = rect.height() / factor;
  if (width <= 0 || height <= 0) return {};
  sums_.resize(static_cast<std::size_t>(width) * factor);
  small_.resize(static_cast<std::size_t>(width) * height);
  const GreyView small{small_.data(), width, height, width};
  for (int y = 0; y < height; ++y) {
    sum_rows(image.row(rect.y0 + y * factor) + rect.x0, image.stride, factor, sums_.data(),
             width * factor);
    mean_columns(sums_.data(), factor, small_.data() + static_cast<std::ptrdiff_t>(y) * width,
                 width);
  }
  return small;
}

}  // namespace handcast::landmarks
