// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/twin/point_spread.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/clones.hpp"

namespace handcast::twin {
namespace {

HANDCAST_CLONES void add_scaled(const float* from, float weight, float* to, int count) {
  for (int x = 0; x < count; ++x) to[x] += weight * from[x];
}

}  // namespace

PointSpread::PointSpread(double sigma_px) {
  const int reach = static_cast<int>(std::ceil(3 * sigma_px));
  double sum = -1;
  for (int i = 0; i <= reach; ++i) {
    half_.push_back(
        reach == 0 ? 1 : static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px))));
    sum += 2 * double(half_.back());
  }
  for (float& weight : half_) weight /= static_cast<float>(sum);
}

void PointSpread::spread_rows(renderer::View<float> image, const renderer::Rect& region) {
  const int width = region.width(), reach = reach_px();
  row_.resize(static_cast<std::size_t>(width) + 2 * static_cast<std::size_t>(reach));
  for (int y = region.y0; y < region.y1; ++y) {
    float* pixels = image.row(y) + region.x0;
    std::copy_n(pixels, width, row_.begin() + reach);
    std::fill_n(row_.begin(), reach, pixels[0]);
    std::fill_n(row_.end() - reach, reach, pixels[width - 1]);
    std::fill_n(pixels, width, 0.0f);
    for (int i = -reach; i <= reach; ++i)
      add_scaled(row_.data() + reach + i, half_[static_cast<std::size_t>(std::abs(i))], pixels,
                 width);
  }
}

void PointSpread::spread_columns(renderer::View<float> image, const renderer::Rect& region) {
  const int width = region.width(), reach = reach_px();
  if (rows_.width() != image.width || rows_.height() != image.height)
    rows_ = renderer::Image<float>(image.width, image.height);
  for (int y = region.y0; y < region.y1; ++y)
    std::copy_n(image.row(y) + region.x0, width, rows_.row(y) + region.x0);
  for (int y = region.y0; y < region.y1; ++y) {
    float* pixels = image.row(y) + region.x0;
    std::fill_n(pixels, width, 0.0f);
    for (int i = -reach; i <= reach; ++i)
      add_scaled(rows_.row(std::clamp(y + i, region.y0, region.y1 - 1)) + region.x0,
                 half_[static_cast<std::size_t>(std::abs(i))], pixels, width);
  }
}

void PointSpread::spread(renderer::View<float> image, const renderer::Rect& region) {
  if (reach_px() == 0 || region.empty()) return;
  spread_rows(image, region);
  spread_columns(image, region);
}

}  // namespace handcast::twin
