// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/mask.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderer/base/clones.hpp"
#include "renderer/mask/threshold.hpp"

namespace handcast::renderer {
namespace {

constexpr double kLeastThreshold = 6, kMostThreshold = 200, kStartThreshold = 40;
/// Share of a new threshold in the mean, which keeps the noise of the images out of the threshold.
constexpr double kThresholdShare = 0.2;
/// A change larger than both (kJumpShare: of the present threshold) is a change of the light and is
/// taken at once.
constexpr double kJump = 5, kJumpShare = 0.2;
constexpr int kLeastArea_px = 150;  ///< smaller parts are not hand, unless a seed is on them
constexpr int kHole_px = 400;       ///< a larger hole is something in front of the hand
constexpr float kFingerReach_px =
    16;  ///< distance of the skin of a finger from its joints, at most
constexpr float kArmMargin_px = 12;

HANDCAST_CLONES void brighter_than(const std::uint8_t* image, int count, std::uint8_t threshold,
                                   std::uint8_t* mask) {
  for (int x = 0; x < count; ++x) mask[x] = image[x] > threshold ? 255 : 0;
}
HANDCAST_CLONES void brighter_than(const std::uint8_t* image, int count,
                                   const std::uint8_t* thresholds, std::uint8_t* mask) {
  for (int x = 0; x < count; ++x) mask[x] = image[x] > thresholds[x] ? 255 : 0;
}

void clear(View<std::uint8_t> mask, int y, int x0, int x1) {
  if (x1 > x0) std::memset(mask.row(y) + x0, 0, static_cast<std::size_t>(x1 - x0));
}

/// Pixels [x0, x1) of a row.
struct Span {
  int x0, x1;
};
/// The part of `within` in which at_zero + slope x is positive.
Span positive(Span within, float at_zero, float slope) {
  if (std::abs(slope) < 1e-6f) return at_zero > 0 ? within : Span{within.x0, within.x0};
  const float root = std::clamp(-at_zero / slope, static_cast<float>(within.x0) - 1,
                                static_cast<float>(within.x1) + 1);
  if (slope > 0) return {std::max(within.x0, static_cast<int>(std::floor(root)) + 1), within.x1};
  return {within.x0, std::min(within.x1, static_cast<int>(std::ceil(root)))};
}

/// The forearm of one hand: the area beyond the line at the wrist, in a band as wide as the hand.
/// Joints of any hand in this area keep their surroundings.
class Forearm {
 public:
  Forearm() = default;
  Forearm(const HandHint& hint, std::span<const HandHint> all)
      : wrist_(hint.wrist_px), out_(hint.to_elbow) {
    for (const glm::vec2& joint : hint.inside_px)
      half_width_ = std::max(half_width_, std::abs(across(joint)));
    half_width_ += kArmMargin_px;
    for (const HandHint& other : all)
      for (const glm::vec2& joint : other.inside_px)
        if (beyond(joint) > kFingerReach_px / 2 &&
            std::abs(across(joint)) < half_width_ + kFingerReach_px && kept_count_ < kept_.size())
          kept_[kept_count_++] = joint;
  }

  /// Removes the forearm from a run. Returns false if nothing is left of the run.
  bool cut(View<std::uint8_t> mask, const RunMap::Run& run) const {
    if (beyond({run.x0, run.y}) <= 0 && beyond({run.x1, run.y}) <= 0) return true;
    const glm::vec2 row_start{0, run.y};
    Span span = positive({run.x0, run.x1}, beyond(row_start), out_.x);
    span = positive(span, half_width_ - across(row_start), out_.y);
    span = positive(span, half_width_ + across(row_start), -out_.y);
    if (kept_count_ == 0) {
      clear(mask, run.y, span.x0, span.x1);
      return span.x1 - span.x0 < run.x1 - run.x0;
    }
    for (int x = span.x0; x < span.x1; ++x)
      if (!near_kept({x, run.y})) mask.at(x, run.y) = 0;
    return true;
  }

 private:
  float beyond(glm::vec2 v) const { return glm::dot(v - wrist_, out_); }
  float across(glm::vec2 v) const { return (v.y - wrist_.y) * out_.x - (v.x - wrist_.x) * out_.y; }
  bool near_kept(glm::vec2 v) const {
    return std::any_of(kept_.begin(), kept_.begin() + kept_count_,
                       [&](glm::vec2 joint) { return glm::distance(v, joint) < kFingerReach_px; });
  }

  glm::vec2 wrist_{0}, out_{0};
  float half_width_ = 0;
  std::array<glm::vec2, msg::kMaxHands * kLandmarks> kept_{};
  std::size_t kept_count_ = 0;
};

void claim_parts(RunMap& runs, const HandHint& hint, int index) {
  bool found = false;
  for (const glm::vec2& seed : hint.inside_px) {
    const int part =
        runs.part_at(static_cast<int>(std::lround(seed.x)), static_cast<int>(std::lround(seed.y)));
    if (part < 0) continue;
    runs.add_owner(part, index);
    found = true;
  }
  if (found) return;
  const int largest = runs.largest_part(hint.region);
  if (largest >= 0 && runs.runs()[largest].area >= kLeastArea_px) runs.add_owner(largest, index);
}

}  // namespace

void MaskFinder::reserve(int width, int height) {
  local_.reserve(width, height);
  reach_.reserve(width, height);
  runs_.reserve(width, height);
  rest_.reserve(width, height);
}

Rect MaskFinder::find(GreyView image, std::span<const HandHint> hints, View<std::uint8_t> mask) {
  hints = hints.first(std::min(hand_bounds_.size(), hints.size()));
  Rect region;
  for (const HandHint& hint : hints)
    region = region.joined(hint.region.within(image.width, image.height));
  hand_bounds_ = {};
  if (region.empty()) return {};

  choose(image, region);
  bound(hints, region);
  binarise(image, region, mask);
  reach_.confine(mask);
  runs_.build(mask, region);

  const int count = static_cast<int>(hints.size());
  std::array<Forearm, msg::kMaxHands> forearms;
  for (int h = 0; h < count; ++h) {
    claim_parts(runs_, hints[h], h);
    forearms[h] = Forearm(hints[h], hints);
  }
  for (const RunMap::Run& run : runs_.runs()) {
    const std::uint8_t owners = runs_.owners(run);
    if (!owners) clear(mask, run.y, run.x0, run.x1);
    bool left = owners != 0;
    for (int h = 0; h < count; ++h)
      if (owners >> h & 1) left &= forearms[h].cut(mask, run);
    for (int h = 0; left && h < count; ++h)
      if (owners >> h & 1)
        hand_bounds_[h] = hand_bounds_[h].joined({run.x0, run.y, run.x1, run.y + 1});
  }
  close_holes(mask);
  return region;
}

/// Sets the pixels above their threshold, inside the bounds.
void MaskFinder::binarise(GreyView image, Rect region, View<std::uint8_t> mask) {
  const bool chosen = settings_.threshold <= 0;
  if (chosen) local_.measure(image, region, threshold_);
  for (int y = region.y0; y < region.y1; ++y) {
    const auto [x0, x1] = reach_.row(y);
    clear(mask, y, region.x0, x0);
    if (chosen)
      brighter_than(image.row(y) + x0, x1 - x0, local_.row(y, x0), mask.row(y) + x0);
    else
      brighter_than(image.row(y) + x0, x1 - x0, static_cast<std::uint8_t>(threshold_),
                    mask.row(y) + x0);
    clear(mask, y, x1, region.x1);
  }
}

/// Fills small dark parts that are inside the inner bound and surrounded by hand.
void MaskFinder::close_holes(View<std::uint8_t> mask) {
  constexpr int kOpen = 0;
  rest_.build_rest(runs_);
  rest_.own_edges(kOpen);
  for (const RunMap::Run& run : rest_.runs())
    if (!rest_.owners(run) && !reach_.surely_holds(run)) rest_.add_owner(rest_.part_of(run), kOpen);
  for (const RunMap::Run& run : rest_.runs())
    if (!rest_.owners(run) && rest_.area(run) <= kHole_px && mask.at(run.x0 - 1, run.y))
      std::memset(mask.row(run.y) + run.x0, 255, static_cast<std::size_t>(run.x1 - run.x0));
}

void MaskFinder::bound(std::span<const HandHint> hints, Rect region) {
  reach_.reset(region);
  for (const HandHint& hint : hints)
    if (hint.capsules.empty())
      reach_.add(hint.region);
    else
      reach_.add(hint.capsules, hint.sure_px, hint.most_px, {hint.wrist_px, hint.to_elbow});
  reach_.settle();
}

void MaskFinder::choose(GreyView image, Rect region) {
  if (settings_.threshold > 0) {
    threshold_ = static_cast<int>(std::lround(settings_.threshold));
    return;
  }
  if (const int chosen = choose_threshold(image, region)) {
    const double bounded = std::clamp<double>(chosen, kLeastThreshold, kMostThreshold);
    const double change = bounded - smooth_threshold_;
    const bool jumps = std::abs(change) > std::max(kJump, kJumpShare * smooth_threshold_);
    smooth_threshold_ += jumps ? change : kThresholdShare * change;
  }
  threshold_ =
      static_cast<int>(std::lround(smooth_threshold_ > 0 ? smooth_threshold_ : kStartThreshold));
}

}  // namespace handcast::renderer
