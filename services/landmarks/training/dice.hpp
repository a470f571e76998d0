// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "services/evaluation/twin/random.hpp"

namespace handcast::landmarks::training {

/// A stream of chance. An image's stream depends on the seed and the image's number alone.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t image) : state_(twin::mixed(twin::mixed(seed) ^ image)) {}

  std::uint64_t bits() { return twin::mixed(state_ += 0x9e3779b97f4a7c15ull); }
  /// In [0, 1).
  float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  float between(float low, float high) { return low + (high - low) * uniform(); }
  bool chance(float probability) { return uniform() < probability; }
  int pick(int count) { return static_cast<int>(bits() >> 33) % count; }
  /// Even in the logarithm.
  float magnitude(float low, float high) {
    return low * std::exp(uniform() * std::log(high / low));
  }
  /// Normal about 0, by Box and Muller.
  float normal(float deviation) {
    const float radius =
        std::sqrt(-2 * std::log((static_cast<float>(bits() >> 40) + 0.5f) * 0x1p-24f));
    return deviation * radius * std::cos(2 * std::numbers::pi_v<float> * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace handcast::landmarks::training
