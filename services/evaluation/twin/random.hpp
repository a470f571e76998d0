// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

/// Chance without a state: every number is a function of (seed, stream, index, ...), so that any
/// process may ask for any sample in any order and all of them see the same world.
namespace handcast::twin {

/// What a number is drawn for. Streams never share numbers.
enum class Stream : std::uint64_t {
  person,
  tracker_time,
  tracker_age,
  tracker_loss,
  tracker_place,
  tracker_drift,
  tracker_noise,
  detector_age,
  detector_loss,
  detector_noise,
  image_noise,
  detector_outlier,
  image_holes,
};

/// The finaliser of splitmix64 (Steele, Lea, Flood 2014).
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

class Random {
 public:
  Random(int seed, Stream stream)
      : key_(mixed(mixed(static_cast<std::uint64_t>(seed)) ^ static_cast<std::uint64_t>(stream))) {}

  std::uint64_t bits(std::uint64_t a, std::uint64_t b = 0) const {
    return mixed(mixed(key_ ^ a) + b);
  }
  /// In [0, 1).
  double uniform(std::uint64_t a, std::uint64_t b = 0) const {
    return static_cast<double>(bits(a, b) >> 11) * 0x1p-53;
  }
  /// In [-1, 1).
  double spread(std::uint64_t a, std::uint64_t b = 0) const { return 2 * uniform(a, b) - 1; }
  /// Standard normal, by Box and Muller.
  double normal(std::uint64_t a, std::uint64_t b = 0) const {
    const std::uint64_t first = bits(a, b);
    const double radius =
        std::sqrt(-2 * std::log((static_cast<double>(first >> 11) + 0.5) * 0x1p-53));
    return radius *
           std::cos(2 * std::numbers::pi * static_cast<double>(mixed(first) >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t key_;
};

}  // namespace handcast::twin
