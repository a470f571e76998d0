// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/film.hpp"

#include <algorithm>

#include "renderer/base/clones.hpp"

namespace handcast::landmarks::training {
namespace {

constexpr int kCropSide_px = handcast_network::kSide_px;
constexpr int kPixels = kCropSide_px * kCropSide_px;

/// An approximately normal number with mean 0 and variance 1, -3.5..3.5: the sum of four uniform
/// ones.
inline float rough_normal(std::uint64_t bits) {
  const std::uint64_t sum =
      (bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48);
  return static_cast<float>(static_cast<int>(sum)) * (1.7320508f / 65536) - 3.4641016f;
}

HANDCAST_CLONES
void add_noise(float* image, std::uint64_t seed, float gain, float pedestal, float even,
               float shot) {
  for (int i = 0; i < kPixels; ++i) {
    const float value = image[i] * gain + pedestal;
    const float deviation = even + shot * (value > 1 ? 1 : value);
    image[i] = value + deviation * rough_normal(twin::mixed(seed + static_cast<std::uint64_t>(i)));
  }
}

HANDCAST_CLONES
void add_scaled(const float* from, float weight, float* to, int count) {
  for (int i = 0; i < count; ++i) to[i] += weight * from[i];
}

HANDCAST_CLONES
void put_behind(const float* wall, const float* cover, float* image) {
  for (int i = 0; i < kPixels; ++i) image[i] += wall[i] * (1 - cover[i]);
}

int clamped(int i) { return std::clamp(i, 0, kCropSide_px - 1); }

/// The brightness of a pattern of the projector, 0..1. `kind`: 0..4.
float pattern_at(int kind, float x, float y) {
  const float sx = std::sin(x), sy = std::sin(y);
  switch (kind) {
    case 0:
      return 0.5f + 0.5f * sx;  // waves
    case 1:
      return sx > 0 ? 1 : 0;  // stripes
    case 2:
      return (sx > 0) != (sy > 0) ? 1 : 0;  // checkers
    case 3:
      return sx > 0.93f || sy > 0.93f ? 1 : 0;  // a grid
    default:
      return sx * sy > 0.55f ? 1 : 0;  // dots
  }
}

}  // namespace

Film::Film() : wall_(kPixels), other_(kPixels) {}

void Film::begin(const std::vector<float>& grey, const std::vector<float>& cover) {
  image_ = grey;
  cover_ = cover;
}

/// Multiplies an image by smooth noise of `cells` cells along a side.
void Film::blend_waves(Dice& dice, int cells, float strength, std::vector<float>& image) {
  const int knots = cells + 1;
  knots_.resize(static_cast<std::size_t>(knots) * knots);
  for (float& knot : knots_) knot = rough_normal(dice.bits());
  std::array<int, kCropSide_px> cell;
  std::array<float, kCropSide_px> ease;
  for (int i = 0; i < kCropSide_px; ++i) {
    const float at = (static_cast<float>(i) + 0.5f) * static_cast<float>(cells) / kCropSide_px;
    cell[i] = static_cast<int>(at);
    const float u = at - static_cast<float>(cell[i]);
    ease[i] = u * u * (3 - 2 * u);
  }
  std::vector<float> row(knots);
  for (int y = 0; y < kCropSide_px; ++y) {
    const float* upper = &knots_[static_cast<std::size_t>(cell[y]) * knots];
    for (int k = 0; k < knots; ++k) row[k] = upper[k] + (upper[k + knots] - upper[k]) * ease[y];
    for (int x = 0; x < kCropSide_px; ++x) {
      const float value = row[cell[x]] + (row[cell[x] + 1] - row[cell[x]]) * ease[x];
      image[y * kCropSide_px + x] *= std::max(0.0f, 1 + strength * value);
    }
  }
}

void Film::texture(Dice& dice) {
  blend_waves(dice, 4, 0.12f, image_);
  blend_waves(dice, 24, dice.between(0, 0.06f), image_);
  if (dice.chance(0.5f)) blend_waves(dice, 56, dice.between(0, 0.06f), image_);
}

/// An ellipse or a box, uniformly bright or shaded like a ball.
void Film::add_thing(Dice& dice) {
  const float x = dice.between(0, kCropSide_px), y = dice.between(0, kCropSide_px),
              angle = dice.between(0, 3.14f);
  const float long_px = dice.magnitude(3, 45), wide_px = dice.magnitude(2, 30),
              bright = dice.chance(0.25f) ? dice.uniform() : dice.between(0, 0.4f);
  const bool box = dice.chance(0.4f), ball = dice.chance(0.3f);
  const float c = std::cos(angle), s = std::sin(angle);
  for (int j = 0; j < kCropSide_px; ++j)
    for (int i = 0; i < kCropSide_px; ++i) {
      const float dx = static_cast<float>(i) - x, dy = static_cast<float>(j) - y;
      const float u = (dx * c + dy * s) / long_px, v = (dy * c - dx * s) / wide_px;
      const float out = box ? std::max(std::abs(u), std::abs(v)) : u * u + v * v;
      if (out < 1)
        wall_[j * kCropSide_px + i] = ball ? bright * std::sqrt(1 - std::min(1.0f, u * u + v * v))
                                           : wall_[j * kCropSide_px + i] + bright;
    }
}

void Film::background(Dice& dice) {
  std::ranges::fill(wall_,
                    dice.chance(0.08f) ? dice.between(0.1f, 0.5f) : dice.between(0.002f, 0.09f));
  blend_waves(dice, 5, 0.4f, wall_);
  if (dice.chance(0.35f))
    for (int things = 1 + dice.pick(4); things > 0; --things) add_thing(dice);
  put_behind(wall_.data(), cover_.data(), image_.data());
}

void Film::leak(Dice& dice) {
  const int kind = dice.pick(5);
  const float angle = dice.between(0, 3.14f),
              period = 2 * std::numbers::pi_v<float> / dice.magnitude(4, 40);
  const float on_hand = dice.chance(0.5f) ? dice.between(0, 0.12f) : dice.between(0.1f, 0.6f),
              on_wall = on_hand * dice.between(0, 0.7f);
  const float c = period * std::cos(angle), s = period * std::sin(angle),
              start = dice.between(0, 6.28f);
  const bool follows = dice.chance(0.6f);  // only the hand is lit
  for (int y = 0; y < kCropSide_px; ++y)
    for (int x = 0; x < kCropSide_px; ++x) {
      const int i = y * kCropSide_px + x;
      const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
      const float light = pattern_at(kind, fx * c + fy * s + start, fy * c - fx * s);
      image_[i] += light * (cover_[i] * on_hand + (follows ? 0 : (1 - cover_[i]) * on_wall));
    }
}

void Film::cover(Dice& dice) {
  const float angle = dice.between(0, 6.28f), c = std::cos(angle), s = std::sin(angle);
  const float edge = dice.between(0.1f, 0.45f) * kCropSide_px, dark = dice.between(0, 0.08f);
  constexpr float kMiddle = kCropSide_px / 2.f;
  for (int y = 0; y < kCropSide_px; ++y)
    for (int x = 0; x < kCropSide_px; ++x)
      if ((static_cast<float>(x) - kMiddle) * c + (static_cast<float>(y) - kMiddle) * s > edge)
        image_[y * kCropSide_px + x] = dark;
}

/// A separable Gaussian.
void Film::blur_across(float sigma_px) {
  const int reach = std::min(6, static_cast<int>(std::ceil(2.5f * sigma_px)));
  std::vector<float> weights;
  float sum = 0;
  for (int k = -reach; k <= reach; ++k)
    sum +=
        weights.emplace_back(std::exp(-0.5f * static_cast<float>(k * k) / (sigma_px * sigma_px)));
  std::vector<float> padded(kCropSide_px + 2 * reach);
  for (int y = 0; y < kCropSide_px; ++y) {
    for (int x = -reach; x < kCropSide_px + reach; ++x)
      padded[x + reach] = image_[y * kCropSide_px + clamped(x)];
    float* row = &other_[y * kCropSide_px];
    std::fill_n(row, kCropSide_px, 0.0f);
    for (int k = 0; k <= 2 * reach; ++k)
      add_scaled(padded.data() + k, weights[k] / sum, row, kCropSide_px);
  }
  std::ranges::fill(image_, 0.0f);
  for (int y = 0; y < kCropSide_px; ++y)
    for (int k = 0; k <= 2 * reach; ++k)
      add_scaled(&other_[clamped(y + k - reach) * kCropSide_px], weights[k] / sum,
                 &image_[y * kCropSide_px], kCropSide_px);
}

/// The mean along a short straight line.
void Film::smear(float length_px, float angle_rad) {
  const int steps = static_cast<int>(length_px) + 2;
  std::ranges::fill(other_, 0.0f);
  for (int k = 0; k < steps; ++k) {
    const float along = (static_cast<float>(k) / static_cast<float>(steps - 1) - 0.5f) * length_px;
    const int dx = static_cast<int>(std::lround(along * std::cos(angle_rad))),
              dy = static_cast<int>(std::lround(along * std::sin(angle_rad)));
    for (int y = 0; y < kCropSide_px; ++y)
      for (int x = 0; x < kCropSide_px; ++x)
        other_[y * kCropSide_px + x] += image_[clamped(y + dy) * kCropSide_px + clamped(x + dx)];
  }
  for (int i = 0; i < kPixels; ++i) image_[i] = other_[i] / static_cast<float>(steps);
}

void Film::blur(Dice& dice) {
  blur_across(dice.chance(0.8f) ? dice.between(0.25f, 1.1f) : dice.between(1.1f, 2.2f));
  if (dice.chance(0.15f))
    smear(dice.chance(0.8f) ? dice.between(1, 6) : dice.between(6, 12), dice.between(0, 3.14f));
}

void Film::develop(Dice& dice, std::vector<std::uint8_t>& pixels) {
  other_ = image_;
  const auto bright = other_.begin() + kPixels * 99 / 100;
  std::nth_element(other_.begin(), bright, other_.end());
  const float exposure = dice.chance(0.2f) ? dice.between(1.1f, 1.9f) : dice.between(0.2f, 1.1f);
  const float pedestal = dice.between(0, 0.04f), even = dice.between(0.002f, 0.018f),
              shot = dice.between(0, 0.025f);
  add_noise(image_.data(), dice.bits(), exposure / std::max(0.03f, *bright), pedestal, even, shot);
  pixels.resize(kPixels);
  for (int i = 0; i < kPixels; ++i)
    pixels[i] = static_cast<std::uint8_t>(std::clamp(image_[i] * 255 + 0.5f, 0.0f, 255.0f));
}

}  // namespace handcast::landmarks::training
