// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/row_spans.hpp"

#include <cmath>

namespace handcast::renderer {
namespace {

constexpr int kBand = 8;  ///< rows that share their spans

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

void RowSpans::reset(Rect region, std::size_t most) {
  region_ = region;
  most_ = most;
  counts_.assign(static_cast<std::size_t>((region.height() + kBand - 1) / kBand), 0);
  spans_.resize(counts_.size() * most);
}

void RowSpans::add(int band, float x0, float x1) {
  const RowSpan span{std::max(region_.x0, static_cast<int>(x0)),
                     std::min(region_.x1, static_cast<int>(x1) + 1)};
  int& count = counts_[band];
  if (span.x0 < span.x1 && static_cast<std::size_t>(count) < most_)
    spans_[band * most_ + count++] = span;
}

void RowSpans::add(const Flesh& flesh, float margin_px) {
  const glm::vec2 from = flesh.from_px, to = flesh.to_px, along = to - from;
  const float from_radius = flesh.from_radius_px + margin_px,
              to_radius = flesh.to_radius_px + margin_px;
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
    RowSpan* const spans = &spans_[band * most_];
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
  return {&spans_[band * most_], static_cast<std::size_t>(counts_[band])};
}

}  // namespace handcast::renderer
