// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/threshold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace handcast::renderer {
namespace {

/// Position between the dark and the bright mean: skin that faces away from the lamp is hand too.
constexpr double kGlobalRimShare = 0.25;
/// Least difference between the means of the two classes.
constexpr double kLeastContrast = 10;
/// Least share of the variance between the classes. A single normal distribution has 0.64.
constexpr double kLeastSeparation = 0.7;
/// Hand is at least kNoises standard deviations of the background above it; a standard deviation
/// counts as at least kLeastNoise.
constexpr int kLeastNoise = 2, kNoises = 4;

using Histogram = std::array<std::uint32_t, 256>;

/// Eight histograms are filled in turn: equal pixels, as those of a dark background, do not wait
/// for each other's count.
Histogram histogram_of(GreyView image, Rect region) {
  constexpr int kRows = 8, kPixels = 4, kLine = 64;
  std::array<Histogram, 8> parts{};
  std::size_t part = 0;
  for (int y = region.y0; y < region.y1; y += kRows) {
    const std::uint8_t* row = image.row(y);
    // The image is new to this core, and the processor does not foresee every eighth row.
    if (const int soon = y + 2 * kRows; soon < region.y1)
      for (int x = region.x0; x < region.x1; x += kLine) __builtin_prefetch(image.row(soon) + x);
    int x = region.x0;
    for (; x + kPixels + 2 < region.x1; x += 2 * kPixels, part ^= 4) {
      ++parts[part][row[x]];
      ++parts[part + 1][row[x + 2]];
      ++parts[part + 2][row[x + 4]];
      ++parts[part + 3][row[x + 6]];
    }
    for (; x < region.x1; x += 2) ++parts[part][row[x]];
  }
  Histogram all{};
  for (const Histogram& one : parts)
    for (std::size_t grey = 0; grey < all.size(); ++grey) all[grey] += one[grey];
  return all;
}

/// The grey value at which the lower `share` of `count` pixels ends.
int percentile(const Histogram& histogram, double count, double share) {
  int grey = 0;
  for (double below = histogram[0]; below < share * count && grey < 255; below += histogram[grey])
    ++grey;
  return grey;
}

}  // namespace

int choose_threshold(GreyView image, Rect region) {
  const Histogram histogram = histogram_of(image, region);
  double count = 0, sum = 0, squares = 0;
  for (int grey = 0; grey < 256; ++grey) {
    const double n = histogram[grey];
    count += n;
    sum += n * grey;
    squares += n * grey * grey;
  }
  if (count == 0) return 0;
  const double variance = squares / count - (sum / count) * (sum / count);

  double dark_count = 0, dark_sum = 0, best = 0, dark_share = 0, dark_mean = 0, bright_mean = 0;
  for (int grey = 0; grey < 255; ++grey) {
    dark_count += histogram[grey];
    dark_sum += static_cast<double>(histogram[grey]) * grey;
    const double bright_count = count - dark_count;
    if (dark_count == 0 || bright_count == 0) continue;
    const double dark = dark_sum / dark_count, bright = (sum - dark_sum) / bright_count;
    const double between =
        dark_count * bright_count / (count * count) * (bright - dark) * (bright - dark);
    if (between <= best) continue;
    best = between;
    dark_share = dark_count;
    dark_mean = dark;
    bright_mean = bright;
  }
  if (bright_mean - dark_mean < kLeastContrast || best < kLeastSeparation * variance) return 0;
  const int ground = percentile(histogram, dark_share, 0.5);
  const int noise = std::max(kLeastNoise, ground - percentile(histogram, dark_share, 0.16));
  const double clear_of_noise =
      std::min<double>(ground + kNoises * noise, 0.5 * (dark_mean + bright_mean));
  return static_cast<int>(std::lround(
      std::max(clear_of_noise, dark_mean + kGlobalRimShare * (bright_mean - dark_mean))));
}

}  // namespace handcast::renderer
