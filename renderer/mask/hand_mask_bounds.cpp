// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include "renderer/base/clones.hpp"
#include "renderer/mask/mask.hpp"

namespace handcast::renderer {
namespace {

constexpr int kBand = 8;  ///< rows that share their spans

std::size_t bands_of(int height) { return static_cast<std::size_t>((height + kBand - 1) / kBand); }

struct Extent {
  float x0 = 1e9f, x1 = -1e9f;
  void take(float from, float to) {
    x0 = std::min(x0, from);
    x1 = std::max(x1, to);
  }
};

/// Extends `extent` to the part of row `y` inside a disc.
void cut_disc(glm::vec2 middle, float radius, float y, Extent& extent) {
  const float squared_half = radius * radius - (y - middle.y) * (y - middle.y);
  if (squared_half <= 0) return;
  const float half = std::sqrt(squared_half);
  extent.take(middle.x - half, middle.x + half);
}
/// Extends `extent` to the point of row `y` on a side from `from` to `to`.
void cut_side(glm::vec2 from, glm::vec2 to, float y, Extent& extent) {
  if ((y - from.y) * (to.y - y) < 0 || from.y == to.y) return;
  const float x = from.x + (to.x - from.x) * (y - from.y) / (to.y - from.y);
  extent.take(x, x);
}

}  // namespace

void RowSpans::reserve(int height) {
  counts_.reserve(bands_of(height));
  spans_.reserve(bands_of(height) * kMost);
}

void RowSpans::reset(Rect region) {
  region_ = region;
  counts_.assign(bands_of(region.height()), 0);
  spans_.resize(counts_.size() * kMost);
}

void RowSpans::add(int band, float x0, float x1) {
  const RowSpan span{std::max(region_.x0, static_cast<int>(x0)),
                     std::min(region_.x1, static_cast<int>(x1) + 1)};
  int& count = counts_[band];
  if (span.x0 < span.x1 && static_cast<std::size_t>(count) < kMost)
    spans_[band * kMost + count++] = span;
}

void RowSpans::add(const Capsule& capsule, float margin_px) {
  const glm::vec2 from = capsule.from_px, to = capsule.to_px, along = to - from;
  const float from_radius = capsule.from_radius_px + margin_px,
              to_radius = capsule.to_radius_px + margin_px;
  const float length = glm::length(along);
  const glm::vec2 across = length > 0 ? glm::vec2(-along.y, along.x) / length : glm::vec2(0);
  const float top = std::min(from.y - from_radius, to.y - to_radius),
              bottom = std::max(from.y + from_radius, to.y + to_radius);
  if (!(top < region_.y1 && bottom > region_.y0)) return;
  const int first = static_cast<int>(std::max(top - static_cast<float>(region_.y0), 0.0f)) / kBand;
  const int last = std::min(
      static_cast<int>(counts_.size()) - 1,
      static_cast<int>(std::min(bottom, static_cast<float>(region_.y1)) - region_.y0) / kBand);
  for (int band = first; band <= last; ++band) {
    const float y = region_.y0 + kBand * band + 0.5f * (kBand - 1);
    Extent extent;
    cut_disc(from, from_radius, y, extent);
    cut_disc(to, to_radius, y, extent);
    for (const float way : {-1.0f, 1.0f})
      cut_side(from + way * from_radius * across, to + way * to_radius * across, y, extent);
    if (extent.x0 < extent.x1) add(band, std::max(extent.x0, -1e6f), std::min(extent.x1, 1e6f));
  }
}

void RowSpans::add(Rect rect) {
  rect = rect.overlap(region_);
  if (rect.empty()) return;
  for (int band = (rect.y0 - region_.y0) / kBand; band <= (rect.y1 - 1 - region_.y0) / kBand;
       ++band)
    add(band, static_cast<float>(rect.x0), static_cast<float>(rect.x1 - 1));
}

void RowSpans::settle() {
  for (std::size_t band = 0; band < counts_.size(); ++band) {
    RowSpan* const spans = &spans_[band * kMost];
    int& count = counts_[band];
    for (int i = 1; i < count; ++i)
      for (int j = i; j > 0 && spans[j].x0 < spans[j - 1].x0; --j)
        std::swap(spans[j], spans[j - 1]);
    int kept = 0;
    for (int i = 1; i < count; ++i) {
      if (spans[i].x0 <= spans[kept].x1)
        spans[kept].x1 = std::max(spans[kept].x1, spans[i].x1);
      else
        spans[++kept] = spans[i];
    }
    if (count > 0) count = kept + 1;
  }
}

std::span<const RowSpan> RowSpans::row(int y) const {
  const int band = (y - region_.y0) / kBand;
  return {&spans_[band * kMost], static_cast<std::size_t>(counts_[band])};
}

namespace {

constexpr int kBeside_px = 2;  ///< width beyond the outer bound in which light counts as continuing
constexpr float kWristMargin_px = 12;
constexpr double kFits =
    0.85;  ///< if more than this share of the inner bound is lit, the bones fit

/// Calls `part(x0, x1)` for each part of [x0, x1) that no span covers.
template <class Part>
void for_each_gap(std::span<const RowSpan> spans, int x0, int x1, Part part) {
  for (const RowSpan& span : spans) {
    if (span.x1 <= x0) continue;
    if (span.x0 >= x1) break;
    if (span.x0 > x0) part(x0, span.x0);
    x0 = span.x1;
  }
  if (x0 < x1) part(x0, x1);
}

HANDCAST_CLONES int count_lit(const std::uint8_t* pixels, int count) {
  int lit = 0;
  for (int x = 0; x < count; ++x) lit += pixels[x] & 1;
  return lit;
}

}  // namespace

void HandMaskBounds::reserve(int width, int height) {
  sure_.reserve(height);
  most_.reserve(height);
  wrists_.reserve(msg::kMaxHands);
  around_.reserve(width, height);
}

void HandMaskBounds::reset(Rect region) {
  region_ = region;
  sure_.reset(region);
  most_.reset(region);
  wrists_.clear();
}

void HandMaskBounds::add(std::span<const Capsule> capsules, float sure_px, float most_px,
                         const Wrist& wrist) {
  for (const Capsule& one : capsules) {
    sure_.add(one, sure_px);
    most_.add(one, most_px);
  }
  wrists_.push_back(wrist);
}

void HandMaskBounds::add(Rect rect) {
  sure_.add(rect);
  most_.add(rect);
}

void HandMaskBounds::settle() {
  sure_.settle();
  most_.settle();
}

RowSpan HandMaskBounds::row(int y) const {
  const auto spans = most_.row(y);
  if (spans.empty()) return {region_.x0, region_.x0};
  return {std::max(region_.x0, spans.front().x0 - kBeside_px),
          std::min(region_.x1, spans.back().x1 + kBeside_px)};
}

bool HandMaskBounds::surely_holds(const RunMap::Run& run) const {
  bool all = true;
  for_each_gap(sure_.row(run.y), run.x0, run.x1, [&](int, int) { all = false; });
  return all;
}

void HandMaskBounds::read_around(View<const std::uint8_t> mask) {
  around_.begin(region_);
  for (int y = region_.y0; y < region_.y1; ++y) {
    const RowSpan seen = row(y);
    for_each_gap(sure_.row(y), seen.x0, seen.x1,
                 [&](int x0, int x1) { around_.read(mask.row(y), y, x0, x1); });
    around_.end_row(y);
  }
}

/// The share of the inner bound that is lit, from every fourth row.
double HandMaskBounds::filled(View<const std::uint8_t> mask) const {
  int lit = 0, all = 0;
  for (int y = region_.y0; y < region_.y1; y += 4)
    for (const auto& [x0, x1] : sure_.row(y)) {
      lit += count_lit(mask.row(y) + x0, x1 - x0);
      all += x1 - x0;
    }
  return all > 0 ? static_cast<double>(lit) / all : 0;
}

bool HandMaskBounds::goes_beyond(const RunMap::Run& run) const {
  bool beyond = false;
  for_each_gap(most_.row(run.y), run.x0, run.x1, [&](int x0, int x1) {
    const glm::vec2 middle(0.5f * static_cast<float>(x0 + x1), run.y);
    bool arm = false;
    for (const Wrist& wrist : wrists_)
      arm = arm || glm::dot(middle - wrist.px, wrist.to_elbow) > -kWristMargin_px;
    beyond = beyond || !arm;
  });
  return beyond;
}

void HandMaskBounds::confine(View<std::uint8_t> mask) {
  const auto darken = [&](int y, int x0, int x1) {
    std::memset(mask.row(y) + x0, 0, static_cast<std::size_t>(x1 - x0));
  };
  read_around(mask);
  const bool bones_fit = filled(mask) > kFits;
  for (const RunMap::Run& run : around_.runs())
    if (bones_fit && goes_beyond(run)) around_.add_owner(around_.part_of(run), 0);
  for (const RunMap::Run& run : around_.runs()) {
    if (around_.owners(run))
      darken(run.y, run.x0, run.x1);
    else
      for_each_gap(most_.row(run.y), run.x0, run.x1,
                   [&](int x0, int x1) { darken(run.y, x0, x1); });
  }
}

}  // namespace handcast::renderer
