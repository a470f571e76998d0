// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/crop/crop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/clones.hpp"
#include "services/landmarks/crop/histogram.hpp"

namespace handcast::landmarks {

// Compiled with -ffp-contract=off: all clones of a loop give the same pixels.

namespace {

using renderer::GreyView;
using renderer::Rect;

/// Rounds to the nearest grey level, in a form that the compiler vectorises.
inline std::uint8_t nearest_level(float level) {
  const float above = level + 0.5f;
  return static_cast<std::uint8_t>(static_cast<int>(above));
}

HANDCAST_CLONES void join_fours(const std::uint8_t* upper, const std::uint8_t* lower,
                                std::uint32_t* out, int count) {
  for (int x = 0; x < count; ++x)
    out[x] = static_cast<std::uint32_t>(upper[x]) | static_cast<std::uint32_t>(upper[x + 1]) << 8 |
             static_cast<std::uint32_t>(lower[x]) << 16 |
             static_cast<std::uint32_t>(lower[x + 1]) << 24;
}

/// Samples from `begin` to `end`, all of which lie in `inner`; `fours` holds its pixels.
HANDCAST_CLONES void sample_inner(const std::uint32_t* __restrict fours, Rect inner, glm::vec2 at,
                                  glm::vec2 step, int begin, int end,
                                  std::uint8_t* __restrict out) {
  const int stride = inner.width(), first = inner.y0 * stride + inner.x0;
  for (int i = begin; i < end; ++i) {
    const float x = at.x + step.x * static_cast<float>(i),
                y = at.y + step.y * static_cast<float>(i);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const auto four = static_cast<std::int32_t>(fours[y0 * stride + x0 - first]);
    const auto a = static_cast<float>(four & 255), b = static_cast<float>((four >> 8) & 255);
    const auto c = static_cast<float>((four >> 16) & 255),
               d = static_cast<float>((four >> 24) & 255);
    const float above = a + (b - a) * fx, below = c + (d - c) * fx;
    out[i] = nearest_level(above + (below - above) * fy);
  }
}

float pixel_or_black(GreyView image, int x, int y) {
  return x >= 0 && y >= 0 && x < image.width && y < image.height ? image.at(x, y) : 0;
}

/// Samples of which some of the four pixels are outside the image.
void sample_edge(GreyView image, glm::vec2 at, glm::vec2 step, int begin, int end,
                 std::uint8_t* out) {
  for (int i = begin; i < end; ++i) {
    const float x = at.x + step.x * static_cast<float>(i),
                y = at.y + step.y * static_cast<float>(i);
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const float above =
        pixel_or_black(image, x0, y0) * (1 - fx) + pixel_or_black(image, x0 + 1, y0) * fx;
    const float below =
        pixel_or_black(image, x0, y0 + 1) * (1 - fx) + pixel_or_black(image, x0 + 1, y0 + 1) * fx;
    out[i] = nearest_level(above * (1 - fy) + below * fy);
  }
}

/// A range of consecutive samples.
struct Run {
  int begin = 0, end = 0;

  Run overlap(Run other) const { return {std::max(begin, other.begin), std::min(end, other.end)}; }
};

/// The first of 0..count-1 for which `is_beyond` is true, or `count`. From there on it must be true
/// for all.
template <class Test>
int first_beyond(int count, Test&& is_beyond) {
  int begin = 0, end = count;
  while (begin < end) {
    const int middle = begin + (end - begin) / 2;
    if (is_beyond(middle))
      end = middle;
    else
      begin = middle + 1;
  }
  return begin;
}

/// The samples with low <= x < high. They are one run, because x is monotonic even when rounded.
Run within(float at, float step, int count, float low, float high) {
  const auto x = [=](int i) { return at + step * static_cast<float>(i); };
  if (std::min(x(0), x(count - 1)) >= low && std::max(x(0), x(count - 1)) < high) return {0, count};
  if (step >= 0)
    return {first_beyond(count, [&](int i) { return x(i) >= low; }),
            first_beyond(count, [&](int i) { return x(i) >= high; })};
  return {first_beyond(count, [&](int i) { return x(i) < high; }),
          first_beyond(count, [&](int i) { return x(i) < low; })};
}

}  // namespace

void Bilinear::prepare(GreyView image, const Rect& rect) {
  image_ = image;
  inner_ = {rect.x0, rect.y0, rect.x1 - 1, rect.y1 - 1};
  if (inner_.empty()) return;
  const int width = inner_.width();
  fours_.resize(static_cast<std::size_t>(width) * inner_.height());
  for (int y = inner_.y0; y < inner_.y1; ++y)
    join_fours(image.row(y) + rect.x0, image.row(y + 1) + rect.x0,
               fours_.data() + static_cast<std::ptrdiff_t>(y - rect.y0) * width, width);
}

void Bilinear::sample(glm::vec2 at, glm::vec2 step, std::span<std::uint8_t> out) const {
  const int count = static_cast<int>(out.size());
  const auto within_both = [&](Rect rect) {
    return within(at.x, step.x, count, static_cast<float>(rect.x0), static_cast<float>(rect.x1))
        .overlap(
            within(at.y, step.y, count, static_cast<float>(rect.y0), static_cast<float>(rect.y1)));
  };
  if (!std::isfinite(at.x + at.y) || !std::isfinite(step.x + step.y)) return;
  const Run touching = within_both({-1, -1, image_.width, image_.height});
  if (touching.end <= touching.begin) return;
  Run inner = inner_.empty() ? Run{} : within_both(inner_);
  if (inner.end <= inner.begin) inner = {touching.end, touching.end};
  sample_edge(image_, at, step, touching.begin, inner.begin, out.data());
  sample_inner(fours_.data(), inner_, at, step, inner.begin, inner.end, out.data());
  sample_edge(image_, at, step, inner.end, touching.end, out.data());
}

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
