// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Width and height of a dither pattern, which repeats over an image.
inline constexpr int kPatternSize = 64;
/// Number of pixels of a dither pattern.
inline constexpr int kPatternPixels = kPatternSize * kPatternSize;

/// Blue noise: each number 0..kPatternPixels - 1 once, so that the pixels with numbers less than n
/// are spread evenly for every n. By void and cluster: Ulichney 1993, "The void-and-cluster method
/// for dither array generation", with its filter of 1.5 px. Always the same pattern; takes about 20
/// ms.
Image<std::uint16_t> blue_noise();

/// When a pixel of a projector without levels is lit: bit plane k of an output frame lights it if
/// its light is above a threshold. The thresholds of a pixel in the N planes are (i + u) / N, with
/// each i < N once and u of the pattern, so the mean of the planes is the light to within 1/N in
/// each pixel, and exact in an area of the pattern. The i of neighbours differ, so that each plane
/// is a dithered picture, and the order of the i spreads the light of a pixel over the output
/// frame. All output frames are alike: a still picture flickers at the output's rate or faster.
class Dither {
 public:
  /// For `planes` (8 or 24) planes. `ranks`: a square pattern with each number once, whose size is
  /// a power of two.
  explicit Dither(int planes, Image<std::uint16_t> ranks = blue_noise());

  /// N.
  int planes() const { return planes_; }
  /// Width and height of the pattern, which repeats over an image.
  int size() const { return ranks_.width(); }
  /// Number of different thresholds: threshold i is the light (i + 0.5) / thresholds().
  int thresholds() const { return planes_ * size() * size(); }
  /// The threshold 0..thresholds() - 1 of a pixel in a plane.
  int at(int plane, int x, int y) const;
  /// The rank of a plane without a pattern: the number of planes that a rising light lights first.
  int turn(int plane) const { return plane * stride_ % planes_; }

 private:
  int planes_, stride_;
  Image<std::uint16_t> ranks_;
};

}  // namespace handcast::renderer
