// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/twin/point_spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/clones.hpp"

namespace handcast::twin {
namespace {

constexpr int kBlock = 16;  ///< pixels whose sums stay in registers

/// to[x] = sum over i of half[i] * (before[i][x] + after[i][x]) for i > 0, and half[0] *
/// before[0][x].
HANDCAST_CLONES void convolve(const std::vector<const float*>& before,
                              const std::vector<const float*>& after,
                              const std::vector<float>& half, float* to, int count) {
  int x = 0;
  for (; x + kBlock <= count; x += kBlock) {
    std::array<float, kBlock> sum;
    for (int k = 0; k < kBlock; ++k) sum[k] = half[0] * before[0][x + k];
    for (std::size_t i = 1; i < half.size(); ++i) {
      const float weight = half[i], *const left = before[i] + x, *const right = after[i] + x;
      for (int k = 0; k < kBlock; ++k) sum[k] += weight * (left[k] + right[k]);
    }
    std::copy_n(sum.begin(), kBlock, to + x);
  }
  for (; x < count; ++x) {
    float sum = half[0] * before[0][x];
    for (std::size_t i = 1; i < half.size(); ++i) sum += half[i] * (before[i][x] + after[i][x]);
    to[x] = sum;
  }
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
  before_.resize(half_.size());
  after_.resize(half_.size());
}

void PointSpread::spread_rows(renderer::View<float> image, const renderer::Rect& region) {
  const int width = region.width(), reach = reach_px();
  row_.resize(static_cast<std::size_t>(width) + 2 * static_cast<std::size_t>(reach));
  for (int y = region.y0; y < region.y1; ++y) {
    float* pixels = image.row(y) + region.x0;
    std::copy_n(pixels, width, row_.begin() + reach);
    std::fill_n(row_.begin(), reach, pixels[0]);
    std::fill_n(row_.end() - reach, reach, pixels[width - 1]);
    for (int i = 0; i <= reach; ++i) {
      before_[static_cast<std::size_t>(i)] = row_.data() + reach - i;
      after_[static_cast<std::size_t>(i)] = row_.data() + reach + i;
    }
    convolve(before_, after_, half_, pixels, width);
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
    const auto row_at = [&](int at) {
      return rows_.row(std::clamp(at, region.y0, region.y1 - 1)) + region.x0;
    };
    for (int i = 0; i <= reach; ++i) {
      before_[static_cast<std::size_t>(i)] = row_at(y - i);
      after_[static_cast<std::size_t>(i)] = row_at(y + i);
    }
    convolve(before_, after_, half_, pixels, width);
  }
}

void PointSpread::spread(renderer::View<float> image, const renderer::Rect& region) {
  if (reach_px() == 0 || region.empty()) return;
  spread_rows(image, region);
  spread_columns(image, region);
}

}  // namespace handcast::twin
