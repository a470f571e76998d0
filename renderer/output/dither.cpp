// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/dither.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace handcast::renderer {
namespace {

/// Pixels that are on or off, and how crowded each pixel is: the sum of a Gaussian of the distances
/// to all that are on. The pattern wraps around at its edges.
class Crowd {
 public:
  Crowd() {
    for (int offset = -kReach; offset <= kReach; ++offset)
      weight_[offset + kReach] =
          std::exp(-static_cast<float>(offset * offset) / (2 * kSigma_px * kSigma_px));
  }

  bool is_on(int pixel) const { return on_[static_cast<std::size_t>(pixel)]; }
  void set(int pixel, bool on) {
    on_[static_cast<std::size_t>(pixel)] = on;
    const int x = pixel % kPatternSize, y = pixel / kPatternSize;
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const float weight = weight_[dx + kReach] * weight_[dy + kReach];
        crowding_.at((x + dx) & (kPatternSize - 1), (y + dy) & (kPatternSize - 1)) +=
            on ? weight : -weight;
      }
  }
  /// The most crowded pixel that is on.
  int tightest_cluster() const {
    int found = 0;
    float most = -std::numeric_limits<float>::infinity();
    for (int pixel = 0; pixel < kPatternPixels; ++pixel)
      if (is_on(pixel) && crowding(pixel) > most) most = crowding(found = pixel);
    return found;
  }
  /// The least crowded pixel that is off.
  int largest_void() const {
    int found = 0;
    float least = std::numeric_limits<float>::infinity();
    for (int pixel = 0; pixel < kPatternPixels; ++pixel)
      if (!is_on(pixel) && crowding(pixel) < least) least = crowding(found = pixel);
    return found;
  }

 private:
  static constexpr float kSigma_px = 1.5f;
  static constexpr int kReach = 9;  ///< six sigma

  float crowding(int pixel) const { return crowding_.pixels()[static_cast<std::size_t>(pixel)]; }

  std::array<bool, kPatternPixels> on_{};
  Image<float> crowding_{kPatternSize, kPatternSize};
  std::array<float, 2 * kReach + 1> weight_{};
};

/// A tenth of the pixels, evenly spread: scattered at random, then moved from clusters to voids
/// until nothing changes.
Crowd first_pixels() {
  Crowd crowd;
  std::uint32_t random = 1;
  for (int left = kPatternPixels / 10; left > 0;) {
    random = random * 1664525u + 1013904223u;  // Numerical Recipes, 7.1
    const int pixel = static_cast<int>(random >> 8) % kPatternPixels;
    if (crowd.is_on(pixel)) continue;
    crowd.set(pixel, true);
    --left;
  }
  for (;;) {
    const int cluster = crowd.tightest_cluster();
    crowd.set(cluster, false);
    const int empty = crowd.largest_void();
    crowd.set(empty, true);
    if (empty == cluster) return crowd;
  }
}

/// Takes 15 ms.
Image<std::uint16_t> ranks_of_pattern() {
  Image<std::uint16_t> rank(kPatternSize, kPatternSize);
  const Crowd first = first_pixels();
  Crowd crowd = first;
  for (int next = kPatternPixels / 10; next-- > 0;) {
    const int pixel = crowd.tightest_cluster();
    crowd.set(pixel, false);
    rank.pixels()[static_cast<std::size_t>(pixel)] = static_cast<std::uint16_t>(next);
  }
  crowd = first;
  // Ulichney fills the last half by the clusters of the pixels that are off: on a pattern that
  // wraps around, these are the voids of those that are on.
  for (int next = kPatternPixels / 10; next < kPatternPixels; ++next) {
    const int pixel = crowd.largest_void();
    crowd.set(pixel, true);
    rank.pixels()[static_cast<std::size_t>(pixel)] = static_cast<std::uint16_t>(next);
  }
  return rank;
}

}  // namespace

Image<std::uint16_t> blue_noise() {
  static const auto ranks = ranks_of_pattern();
  return ranks;
}

/// The steps of i from plane to plane, without a common divisor with N: those with the least
/// flicker in `scripts/bench outputs`.
static constexpr int kStrideOf24 = 5, kStrideOf8 = 3;

Dither::Dither(int planes, Image<std::uint16_t> ranks)
    : planes_(planes), stride_(planes == 8 ? kStrideOf8 : kStrideOf24), ranks_(std::move(ranks)) {}

int Dither::at(int plane, int x, int y) const {
  // i and u come from two places of the pattern, so that they do not depend on each other.
  const int mask = size() - 1, far_x = size() / 2, far_y = size() / 4 + 1;
  const int start = ranks_.at(x & mask, y & mask) * planes_ / (size() * size());
  const int share = ranks_.at((x + far_x) & mask, (y + far_y) & mask);
  return (start + turn(plane)) % planes_ * size() * size() + share;
}

}  // namespace handcast::renderer
