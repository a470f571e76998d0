// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/image_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderer/base/clones.hpp"
#include "services/lab/twin/image_faults.hpp"

namespace handcast::twin {
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
