// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/image_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderer/base/clones.hpp"
#include "services/lab/twin/image_faults.hpp"

namespace handcast::twin {
namespace {

/// to[x] = the sum of weights[i] rows[i][x]. Four rows at a time: each pass reads and writes `to`.
HANDCAST_CLONES void add_up(const float* const* rows, const float* weights, int count, float* to,
                            int width) {
  for (int x = 0; x < width; ++x) to[x] = 0;
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    const float *a = rows[i], *b = rows[i + 1], *c = rows[i + 2], *d = rows[i + 3];
    const float wa = weights[i], wb = weights[i + 1], wc = weights[i + 2], wd = weights[i + 3];
    for (int x = 0; x < width; ++x) {
      float sum = to[x];
      sum += wa * a[x];
      sum += wb * b[x];
      sum += wc * c[x];
      sum += wd * d[x];
      to[x] = sum;
    }
  }
  for (; i < count; ++i)
    for (int x = 0; x < width; ++x) to[x] += weights[i] * rows[i][x];
}

}  // namespace

PointSpread::PointSpread(double sigma_px) {
  const int reach = static_cast<int>(std::ceil(3 * sigma_px));
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    weights_.push_back(
        reach == 0 ? 1 : static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px))));
    sum += double(weights_.back());
  }
  for (float& weight : weights_) weight /= static_cast<float>(sum);
  sources_.resize(weights_.size());
}

void PointSpread::spread_rows(renderer::View<float> image, const renderer::Rect& region) {
  const int width = region.width(), reach = reach_px();
  row_.resize(static_cast<std::size_t>(width) + 2 * static_cast<std::size_t>(reach));
  for (std::size_t i = 0; i < sources_.size(); ++i) sources_[i] = row_.data() + i;
  for (int y = region.y0; y < region.y1; ++y) {
    float* pixels = image.row(y) + region.x0;
    std::copy_n(pixels, width, row_.begin() + reach);
    std::fill_n(row_.begin(), reach, pixels[0]);
    std::fill_n(row_.end() - reach, reach, pixels[width - 1]);
    add_up(sources_.data(), weights_.data(), 2 * reach + 1, pixels, width);
  }
}

void PointSpread::spread_columns(renderer::View<float> image, const renderer::Rect& region) {
  const int width = region.width(), reach = reach_px();
  if (rows_.width() != image.width || rows_.height() != image.height)
    rows_ = renderer::Image<float>(image.width, image.height);
  for (int y = region.y0; y < region.y1; ++y)
    std::copy_n(image.row(y) + region.x0, width, rows_.row(y) + region.x0);
  for (int y = region.y0; y < region.y1; ++y) {
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const int from = y + static_cast<int>(i) - reach;
      sources_[i] = rows_.row(std::clamp(from, region.y0, region.y1 - 1)) + region.x0;
    }
    add_up(sources_.data(), weights_.data(), 2 * reach + 1, image.row(y) + region.x0, width);
  }
}

void PointSpread::spread(renderer::View<float> image, const renderer::Rect& region) {
  if (reach_px() == 0 || region.empty()) return;
  spread_rows(image, region);
  spread_columns(image, region);
}

namespace {

constexpr std::size_t kNoiseSize = 1 << 18;

HANDCAST_CLONES
void add_noise(const std::uint8_t* scene, const std::int8_t* noise, std::uint8_t* out, int count) {
  for (int x = 0; x < count; ++x) {
    const int value = scene[x] + noise[x];
    out[x] = static_cast<std::uint8_t>(value < 0 ? 0 : value > 255 ? 255 : value);
  }
}

HANDCAST_CLONES
void round_row(const float* sum, float scale, std::uint8_t* out, int count) {
  for (int x = 0; x < count; ++x) {
    const float value = sum[x] * scale + 0.5f;
    out[x] = static_cast<std::uint8_t>(static_cast<int>(value > 255.0f ? 255.0f : value));
  }
}

}  // namespace

ImageSensor::ImageSensor(const config::TwinImage& settings, int seed, int width_px)
    : settings_(settings),
      random_(seed, Stream::image_noise),
      spread_(settings.spread_px),
      noise_(kNoiseSize + static_cast<std::size_t>(width_px)),
      row_(static_cast<std::size_t>(width_px)) {
  for (std::size_t i = 0; i < noise_.size(); ++i) {
    const double value = std::clamp(settings_.noise * random_.normal(i, 1), -127.0, 127.0);
    noise_[i] = static_cast<std::int8_t>(std::lround(value));
  }
}

void ImageSensor::set_empty_scene(renderer::Image<float> greys) {
  spread_.spread(greys.view(), {0, 0, greys.width(), greys.height()});
  empty_scene_ = renderer::Image<std::uint8_t>(greys.width(), greys.height());
  for (int y = 0; y < greys.height(); ++y)
    round_row(greys.row(y), 1, empty_scene_.row(y), greys.width());
}

void ImageSensor::develop(std::uint64_t k, renderer::View<float> sum, const renderer::Rect& region,
                          int instants, bool faulty, renderer::View<std::uint8_t> image) {
  spread_.spread(sum, region);
  const int width = std::min(image.width, empty_scene_.width());
  for (int y = 0; y < std::min(image.height, empty_scene_.height()); ++y) {
    const std::int8_t* noise =
        &noise_[random_.bits(k, 2 + static_cast<std::uint64_t>(y)) % kNoiseSize];
    std::memcpy(row_.data(), empty_scene_.row(y), row_.size());
    if (y >= region.y0 && y < region.y1)
      round_row(sum.row(y) + region.x0, 1 / static_cast<float>(instants), row_.data() + region.x0,
                region.width());
    if (faulty) spoil_row(settings_, row_);
    add_noise(row_.data(), noise, image.row(y), width);
  }
}

}  // namespace handcast::twin
