// SPDX-License-Identifier: Apache-2.0
#include "services/content/scaled.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/base/clones.hpp"

namespace handcast::content {
namespace {

/// What each pixel of a row or column is made of: `count` pixels from `first`, and their weights.
struct Taps {
  struct Tap {
    int first, count;
    std::size_t weights;
  };
  std::vector<Tap> taps;
  std::vector<float> weights;

  Taps(int from, int to) {
    const double step = static_cast<double>(from) / to;
    for (int i = 0; i < to; ++i) step > 1 ? cover(i * step, step, from) : between(i, step, from);
  }

 private:
  /// The mean from `begin` over a length of `step` pixels.
  void cover(double begin, double step, int from) {
    const double end = begin + step;
    const int first = static_cast<int>(begin);
    const int last = std::min(static_cast<int>(std::ceil(end - 1e-9)), from);
    taps.push_back({first, last - first, weights.size()});
    for (int k = first; k < last; ++k)
      weights.push_back(
          static_cast<float>((std::min(end, k + 1.) - std::max(begin, 0. + k)) / step));
  }
  void between(int i, double step, int from) {
    const double at = std::clamp((i + 0.5) * step - 0.5, 0., from - 1.);
    const int first = std::min(static_cast<int>(at), std::max(0, from - 2));
    const auto part = static_cast<float>(at - first);
    taps.push_back({first, std::min(2, from), weights.size()});
    weights.push_back(1 - part);
    if (from > 1) weights.push_back(part);
  }
};

HANDCAST_CLONES void add_row(const std::uint32_t* row, std::size_t count, float weight,
                             float* sums) {
  for (std::size_t i = 0; i < count; ++i)
    for (int k = 0; k < 4; ++k)
      sums[4 * i + k] += weight * static_cast<float>(static_cast<int>(row[i] >> 8 * k & 255));
}

/// The sum of each pixel of a row along x, as four levels.
void gather_row(const float* sums, const Taps& taps, std::uint32_t* out) {
  for (const auto& [first, count, weights] : taps.taps) {
    float level[4] = {0.5f, 0.5f, 0.5f, 0.5f};
    for (int j = 0; j < count; ++j)
      for (int k = 0; k < 4; ++k) level[k] += taps.weights[weights + j] * sums[4 * (first + j) + k];
    std::uint32_t pixel = 0;
    for (int k = 0; k < 4; ++k)
      pixel |= static_cast<std::uint32_t>(std::min(static_cast<int>(level[k]), 255)) << 8 * k;
    *out++ = pixel;
  }
}

}  // namespace

renderer::Texture scaled(renderer::View<const std::uint32_t> picture, int width, int height) {
  renderer::Texture out(width, height);
  const Taps columns(picture.width, width), rows(picture.height, height);
  const auto count = static_cast<std::size_t>(picture.width);
  std::vector<float> sums(4 * count);
  for (int y = 0; y < height; ++y) {
    std::ranges::fill(sums, 0.f);
    const auto& tap = rows.taps[static_cast<std::size_t>(y)];
    for (int j = 0; j < tap.count; ++j)
      add_row(picture.row(tap.first + j), count, rows.weights[tap.weights + j], sums.data());
    gather_row(sums.data(), columns, out.row(y));
  }
  return out;
}

renderer::Texture fitted(renderer::View<const std::uint32_t> picture, int width, int height,
                         Fit fit) {
  if (fit == Fit::stretch) return scaled(picture, width, height);
  const double across = static_cast<double>(width) / picture.width,
               down = static_cast<double>(height) / picture.height;
  const auto pixels = [](double size, int least, int most) {
    return std::clamp(static_cast<int>(std::lround(size)), least, most);
  };
  renderer::Texture out(width, height);
  if (fit == Fit::contain) {
    const double scale = std::min(across, down);
    const auto whole = scaled(picture, pixels(picture.width * scale, 1, width),
                              pixels(picture.height * scale, 1, height));
    const int left = (width - whole.width()) / 2, top = (height - whole.height()) / 2;
    for (int y = 0; y < whole.height(); ++y)
      std::copy_n(whole.row(y), whole.width(), out.row(top + y) + left);
    return out;
  }
  const double scale = std::max(across, down);
  const int kept_x = pixels(width / scale, 1, picture.width),
            kept_y = pixels(height / scale, 1, picture.height);
  const int left = (picture.width - kept_x) / 2, top = (picture.height - kept_y) / 2;
  return scaled({picture.row(top) + left, kept_x, kept_y, picture.stride}, width, height);
}

}  // namespace handcast::content
