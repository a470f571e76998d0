// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "services/lab/twin/random.hpp"

namespace handcast::landmarks::training {

/// A stream of pseudorandom numbers for one image. One thread.
class Dice {
 public:
  /// The stream depends on the seed and the number of the image alone.
  Dice(std::uint64_t seed, std::uint64_t image) : state_(twin::mixed(twin::mixed(seed) ^ image)) {}

  /// 64 random bits.
  std::uint64_t bits() { return twin::mixed(state_ += 0x9e3779b97f4a7c15ull); }
  /// Uniform in [0, 1).
  float uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
  /// Uniform in [low, high).
  float between(float low, float high) { return low + (high - low) * uniform(); }
  /// True with this probability.
  bool chance(float probability) { return uniform() < probability; }
  /// One of 0..count-1.
  int pick(int count) { return static_cast<int>(bits() >> 33) % count; }
  /// In [low, high), with a uniform logarithm.
  float magnitude(float low, float high) {
    return low * std::exp(uniform() * std::log(high / low));
  }
  /// Normal with mean 0, by the method of Box and Muller.
  float normal(float deviation) {
    const float radius =
        std::sqrt(-2 * std::log((static_cast<float>(bits() >> 40) + 0.5f) * 0x1p-24f));
    return deviation * radius * std::cos(2 * std::numbers::pi_v<float> * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace handcast::landmarks::training
