// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/crop/crop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/landmarks/crop/histogram.hpp"

namespace handcast::landmarks {
namespace {

using renderer::GreyView;
using renderer::Rect;

/// Crop pixel (0, 0) and the steps to its right and lower neighbours, in image pixels.
struct Walk {
  glm::vec2 start, right, down;
};

Walk walk_over(const Region& region, int side_px, glm::vec2 origin_px, float pixel_px) {
  const auto at = [&](float x, float y) {
    const glm::vec2 place = glm::vec2(x + 0.5f, y + 0.5f) / static_cast<float>(side_px) - 0.5f;
    return (region.to_image(place) - origin_px) / pixel_px;
  };
  return {at(0, 0), at(1, 0) - at(0, 0), at(0, 1) - at(0, 0)};
}

Rect bounds_of(const Region& region, GreyView image) {
  glm::vec2 low = region.to_image({-0.5f, -0.5f}), high = low;
  for (const glm::vec2 corner : {glm::vec2{0.5f, -0.5f}, {-0.5f, 0.5f}, {0.5f, 0.5f}}) {
    low = glm::min(low, region.to_image(corner));
    high = glm::max(high, region.to_image(corner));
  }
  const glm::vec2 size(image.width, image.height);
  low = glm::clamp(low, glm::vec2(0), size);
  high = glm::clamp(high, glm::vec2(-1), size);
  return Rect{static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x) + 2,
              static_cast<int>(high.y) + 2}
      .within(image.width, image.height);
}

/// The part of the image to shrink: the region's box with a margin, so that every pixel the crop
/// samples is in it. At the right or lower edge of the image it begins so that whole factors end
/// at that edge.
Rect whole_steps(const Rect& box, int factor, GreyView image) {
  Rect rect = box.grown(2 * factor).within(image.width, image.height);
  if (rect.x1 == image.width && rect.x0 > 0) rect.x0 += rect.width() % factor;
  if (rect.y1 == image.height && rect.y0 > 0) rect.y0 += rect.height() % factor;
  return rect;
}

/// Otsu's threshold: the last value of the darker class, chosen for the largest variance between
/// the two classes.
int split_of(const Histogram& histogram, double count) {
  double sum = 0, dark_count = 0, dark_sum = 0, best = -1;
  for (int i = 0; i < 256; ++i) sum += static_cast<double>(i) * histogram[i];
  int split = 0;
  for (int i = 0; i < 255; ++i) {
    dark_count += histogram[i];
    dark_sum += static_cast<double>(i) * histogram[i];
    if (dark_count == 0 || dark_count == count) continue;
    const double gap = dark_sum / dark_count - (sum - dark_sum) / (count - dark_count);
    const double between = dark_count * (count - dark_count) * gap * gap;
    if (between > best) best = between, split = i;
  }
  return split;
}

float bright_median(std::span<const std::uint8_t> pixels) {
  const Histogram histogram = histogram_of(pixels);
  const int split = split_of(histogram, static_cast<double>(pixels.size()));
  std::uint64_t bright = 0, passed = 0;
  for (int i = split + 1; i < 256; ++i) bright += histogram[i];
  for (int i = split + 1; i < 256; ++i)
    if (2 * (passed += histogram[i]) >= bright && bright > 0) return static_cast<float>(i);
  return static_cast<float>(split);
}

}  // namespace

void Crop::cut(GreyView image, const Region& region) {
  std::ranges::fill(pixels_, std::uint8_t{0});
  const float pixel_px = region.size_px / static_cast<float>(side_px_);
  if (!std::isfinite(pixel_px)) return;
  const int factor = std::clamp(static_cast<int>(std::lround(pixel_px)), 1, kMostFactor);
  const Rect box = bounds_of(region, image),
             rect = factor > 1 ? whole_steps(box, factor, image)
                               : box.grown(1).within(image.width, image.height);
  const GreyView source = factor > 1 ? smaller_.shrink(image, rect, factor) : image;
  if (source.width <= 0 || source.height <= 0) return;
  samples_.prepare(source, factor > 1 ? Rect{0, 0, source.width, source.height} : rect);
  const glm::vec2 first_px =
      glm::vec2(rect.x0, rect.y0) +
      0.5f * static_cast<float>(factor - 1);  // the centre of the source's first pixel
  const Walk walk =
      walk_over(region, side_px_, factor > 1 ? first_px : glm::vec2(0), static_cast<float>(factor));
  const std::span<std::uint8_t> pixels = pixels_;
  for (int y = 0; y < side_px_; ++y)
    samples_.sample(walk.start + walk.down * static_cast<float>(y), walk.right,
                    pixels.subspan(static_cast<std::size_t>(y) * side_px_, side_px_));
}

float Crop::level() const { return bright_median(pixels_); }

void Crop::write_rgb(std::span<float> rgb) const {
  const float gain = std::min(kHandLevel / std::max(level(), 1.0f), kMostGain);
  std::array<float, 256> value;
  for (int i = 0; i < 256; ++i) value[i] = std::min(static_cast<float>(i) * gain / 255, 1.0f);
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = value[pixels_[i]];
}

}  // namespace handcast::landmarks
