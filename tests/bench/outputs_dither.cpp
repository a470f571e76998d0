// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/outputs_dither.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <random>
#include <vector>

namespace handcast::bench {
namespace {

using renderer::Image;
using renderer::kPatternPixels;
using renderer::kPatternSize;

constexpr std::array kGreys{0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 0.95};

constexpr int kFastest_px = 3;  ///< per plane

/// The image as the eye sees it. It wraps around.
Image<double> seen(const Image<double>& image) {
  constexpr double kEye_px = 1.5;
  constexpr int kReach = 8;
  const auto blur = [](const Image<double>& from, int dx, int dy) {
    Image<double> to(kPatternSize, kPatternSize);
    double all = 0;
    for (int i = -kReach; i <= kReach; ++i) all += std::exp(-i * i / (2 * kEye_px * kEye_px));
    for (int y = 0; y < kPatternSize; ++y)
      for (int x = 0; x < kPatternSize; ++x)
        for (int i = -kReach; i <= kReach; ++i)
          to.at(x, y) +=
              std::exp(-i * i / (2 * kEye_px * kEye_px)) / all *
              from.at((x + i * dx) & (kPatternSize - 1), (y + i * dy) & (kPatternSize - 1));
    return to;
  };
  return blur(blur(image, 1, 0), 0, 1);
}

double mean_of(const Image<double>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.) / kPatternPixels;
}

/// RMS of the differences from `grey`.
double rms_of(const Image<double>& image, double grey) {
  double squares = 0;
  for (const double pixel : image.pixels()) squares += (pixel - grey) * (pixel - grey);
  return std::sqrt(squares / kPatternPixels);
}

/// What an eye sees that follows something that moves by (dx, dy) px from plane to plane.
Image<double> followed(const std::vector<Image<double>>& planes, int dx, int dy) {
  constexpr int kMask = kPatternSize - 1;
  Image<double> sum(kPatternSize, kPatternSize);
  for (std::size_t k = 0; k < planes.size(); ++k)
    for (int y = 0; y < kPatternSize; ++y)
      for (int x = 0; x < kPatternSize; ++x)
        sum.at(x, y) += planes[k].at((x + static_cast<int>(k) * dx) & kMask,
                                     (y + static_cast<int>(k) * dy) & kMask) /
                        static_cast<double>(planes.size());
  return sum;
}

/// RMS of the parts of the light that change `times` times per output frame.
double harmonic(const std::vector<Image<double>>& planes, int times) {
  double squares = 0;
  for (int i = 0; i < kPatternPixels; ++i) {
    std::complex<double> sum;
    for (std::size_t k = 0; k < planes.size(); ++k)
      sum += planes[k].pixels()[static_cast<std::size_t>(i)] *
             std::polar(1., -2 * M_PI * times * static_cast<double>(k) /
                                static_cast<double>(planes.size()));
    squares += std::norm(sum) * 2 / static_cast<double>(planes.size() * planes.size());
  }
  return std::sqrt(squares / kPatternPixels);
}

}  // namespace

DitherNoise noise_of(const renderer::Dither& dither, bool moves) {
  DitherNoise noise;
  for (const double grey : kGreys) {
    std::vector<Image<double>> planes;
    Image<double> sum(kPatternSize, kPatternSize);
    for (int plane = 0; plane < dither.planes(); ++plane) {
      Image<double> lit(kPatternSize, kPatternSize);
      for (int y = 0; y < kPatternSize; ++y)
        for (int x = 0; x < kPatternSize; ++x) {
          lit.at(x, y) = grey * dither.thresholds() > dither.at(moves ? plane : 0, x, y) + 0.5;
          sum.at(x, y) += lit.at(x, y) / dither.planes();
        }
      planes.push_back(seen(lit));
      noise.plane += rms_of(planes.back(), grey) / dither.planes() / kGreys.size();
    }
    for (int dy = -kFastest_px; dy <= kFastest_px; ++dy)
      for (int dx = 0; dx <= kFastest_px; ++dx) {
        const double rms = rms_of(followed(planes, dx, dy), grey);
        noise.followed += rms / (kGreys.size() * (kFastest_px + 1) * (2 * kFastest_px + 1));
        noise.worst = std::max(noise.worst, rms);
      }
    noise.mean_error = std::max(noise.mean_error, std::abs(mean_of(sum) - grey));
    noise.frame += rms_of(seen(sum), grey) / kGreys.size();
    noise.flicker += std::hypot(harmonic(planes, 1), harmonic(planes, 2)) / kGreys.size();
  }
  return noise;
}

Image<std::uint16_t> bayer_pattern() {
  Image<std::uint16_t> pattern(kPatternSize, kPatternSize);
  for (int y = 0; y < kPatternSize; ++y)
    for (int x = 0; x < kPatternSize; ++x) {
      int rank = 0;
      for (int bit = 0; 1 << bit < kPatternSize; ++bit)
        rank = rank << 2 | ((x ^ y) >> bit & 1) << 1 | (y >> bit & 1);
      pattern.at(x, y) = static_cast<std::uint16_t>(rank);
    }
  return pattern;
}

Image<std::uint16_t> white_noise() {
  Image<std::uint16_t> pattern(kPatternSize, kPatternSize);
  std::iota(pattern.pixels().begin(), pattern.pixels().end(), std::uint16_t{0});
  std::shuffle(pattern.pixels().begin(), pattern.pixels().end(), std::mt19937(1));
  return pattern;
}

}  // namespace handcast::bench
