// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/hand_mask_bounds.hpp"

#include <cstring>

#include "renderer/base/clones.hpp"

namespace handcast::renderer {
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

void HandMaskBounds::reset(Rect region, std::size_t shapes) {
  region_ = region;
  sure_.reset(region, shapes);
  most_.reset(region, shapes);
  wrists_.clear();
}

void HandMaskBounds::add(std::span<const Flesh> flesh, float sure_px, float most_px,
                         const Wrist& wrist) {
  for (const Flesh& one : flesh) {
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
