#include "services/landmarks/crop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/clones.hpp"

namespace handcast::landmarks {
namespace {

using renderer::GreyView;
using renderer::Rect;
using Histogram = std::array<std::uint32_t, 256>;

/// Crop pixel (0,0), and the steps to its right and lower neighbours, in image px.
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

float pixel_or_black(GreyView image, int x, int y) { return x >= 0 && y >= 0 && x < image.width && y < image.height ? image.at(x, y) : 0; }

float sample_at_edge(GreyView image, float x, float y) {
  if (!(x > -1 && y > -1 && x < static_cast<float>(image.width) && y < static_cast<float>(image.height))) return 0;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const float above = pixel_or_black(image, x0, y0) * (1 - fx) + pixel_or_black(image, x0 + 1, y0) * fx;
  const float below = pixel_or_black(image, x0, y0 + 1) * (1 - fx) + pixel_or_black(image, x0 + 1, y0 + 1) * fx;
  return above * (1 - fy) + below * fy;
}

void sample_row(GreyView image, glm::vec2 at, glm::vec2 step, int count, std::uint8_t* out) {
  const auto inner_width = static_cast<float>(image.width - 1), inner_height = static_cast<float>(image.height - 1);
  for (int i = 0; i < count; ++i) {
    const float x = at.x + step.x * static_cast<float>(i), y = at.y + step.y * static_cast<float>(i);
    if (!(x >= 0 && y >= 0 && x < inner_width && y < inner_height)) {
      out[i] = static_cast<std::uint8_t>(sample_at_edge(image, x, y) + 0.5f);
      continue;
    }
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const std::uint8_t* p = image.row(y0) + x0;
    const std::uint8_t* q = p + image.stride;
    const auto a = static_cast<float>(p[0]), b = static_cast<float>(p[1]), c = static_cast<float>(q[0]), d = static_cast<float>(q[1]);
    const float above = a + (b - a) * fx, below = c + (d - c) * fx;
    out[i] = static_cast<std::uint8_t>(above + (below - above) * fy + 0.5f);
  }
}

HANDCAST_CLONES void add_row(const std::uint8_t* row, std::uint16_t* sums, int count) {
  for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + row[i]);
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
  return Rect{static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x) + 2, static_cast<int>(high.y) + 2}.within(
      image.width, image.height);
}

Histogram histogram_of(std::span<const std::uint8_t> pixels) {
  Histogram histogram{};
  for (const auto pixel : pixels) ++histogram[pixel];
  return histogram;
}

/// Otsu's: the last value of the darker one of two parts whose means are best told apart.
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

/// The part of the image under the region, each pixel the mean of factor x factor; `origin_px` is the middle of its first pixel.
GreyView Crop::shrunk(GreyView image, const Region& region, int factor, glm::vec2& origin_px) {
  const Rect rect = bounds_of(region, image);
  const int width = rect.width() / factor, height = rect.height() / factor;
  origin_px = glm::vec2(rect.x0, rect.y0) + 0.5f * static_cast<float>(factor - 1);
  if (width <= 0 || height <= 0) return {};
  small_.resize(static_cast<std::size_t>(width) * height);
  std::vector<std::uint16_t> sums(static_cast<std::size_t>(width) * factor);
  const int area = factor * factor;
  for (int y = 0; y < height; ++y) {
    std::ranges::fill(sums, std::uint16_t{0});
    for (int k = 0; k < factor; ++k) add_row(image.row(rect.y0 + y * factor + k) + rect.x0, sums.data(), width * factor);
    for (int x = 0; x < width; ++x) {
      int sum = area / 2;
      for (int k = 0; k < factor; ++k) sum += sums[static_cast<std::size_t>(x) * factor + k];
      small_[static_cast<std::size_t>(y) * width + x] = static_cast<std::uint8_t>(sum / area);
    }
  }
  return {small_.data(), width, height, width};
}

void Crop::cut(GreyView image, const Region& region) {
  const float pixel_px = region.size_px / static_cast<float>(side_px_);
  const int factor = std::isfinite(pixel_px) ? std::clamp(static_cast<int>(std::lround(pixel_px)), 1, 64) : 1;
  glm::vec2 origin_px(0);
  const GreyView source = factor > 1 ? shrunk(image, region, factor, origin_px) : image;
  if (source.width <= 0 || source.height <= 0 || !std::isfinite(pixel_px)) {
    std::ranges::fill(pixels_, std::uint8_t{0});
  } else {
    const Walk walk = walk_over(region, side_px_, origin_px, static_cast<float>(factor));
    for (int y = 0; y < side_px_; ++y)
      sample_row(source, walk.start + walk.down * static_cast<float>(y), walk.right, side_px_,
                 pixels_.data() + static_cast<std::ptrdiff_t>(y) * side_px_);
  }
  level_ = bright_median(pixels_);
}

void Crop::write_rgb(std::span<float> rgb) const {
  const float gain = std::min(kHandLevel / std::max(level_, 1.0f), kMostGain);
  std::array<float, 256> value;
  for (int i = 0; i < 256; ++i) value[i] = std::min(static_cast<float>(i) * gain / 255, 1.0f);
  for (std::size_t i = 0; i < pixels_.size(); ++i) rgb[3 * i] = rgb[3 * i + 1] = rgb[3 * i + 2] = value[pixels_[i]];
}

}  // namespace handcast::landmarks
