// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/hand_mask.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderer/base/similarity.hpp"

namespace handcast::renderer {
namespace {

constexpr int kMargin_px = 2;
constexpr int kGoodPart = 4;  ///< a hand is shown if 1/4 of the area of its bounds remains

int area_of(const Rect& bounds) { return bounds.empty() ? 0 : bounds.width() * bounds.height(); }

void fill_rect(Image<std::uint8_t>& image, const Rect& region, std::uint8_t value) {
  for (int y = region.y0; y < region.y1; ++y)
    std::memset(image.row(y) + region.x0, value, static_cast<std::size_t>(region.width()));
}

/// Bounds of the points that `move` maps into `region`.
Rect moved_back(const Rect& region, const Similarity& move) {
  const glm::mat2 turn(glm::vec2(move.cosine, move.sine), glm::vec2(-move.sine, move.cosine));
  const glm::mat2 back = glm::inverse(turn);
  glm::vec2 low(1e6f), high(-1e6f);
  for (const glm::vec2 corner :
       {glm::vec2(region.x0, region.y0), glm::vec2(region.x1, region.y0),
        glm::vec2(region.x0, region.y1), glm::vec2(region.x1, region.y1)}) {
    const glm::vec2 there = back * (corner - move.shift);
    low = glm::min(low, there);
    high = glm::max(high, there);
  }
  return {static_cast<int>(std::floor(low.x)), static_cast<int>(std::floor(low.y)),
          static_cast<int>(std::ceil(high.x)), static_cast<int>(std::ceil(high.y))};
}

}  // namespace

HandMask::HandMask(const config::Mask& settings, const calib::Calibration& calibration, bool smooth)
    : settings_(settings),
      calibration_(calibration),
      finder_(settings),
      lookup_(calibration, smooth),
      nearness_{NearnessGrid(lookup_.columns(), lookup_.rows(), CameraLookup::kStep),
                NearnessGrid(lookup_.columns(), lookup_.rows(), CameraLookup::kStep)},
      projector_mask_(calibration.projector.width_px, calibration.projector.height_px) {
  const auto reserve = [](auto&... all) { (all.reserve(msg::kMaxHands), ...); };
  reserve(sought_, owned_hints_, hints_, found_);
  set_size(calibration.camera.width_px, calibration.camera.height_px);
}

/// Allocates what has the size of the camera's image, if it changes, and forgets the hands then.
void HandMask::set_size(int width, int height) {
  if (camera_mask_.width() == width && camera_mask_.height() == height) return;
  camera_mask_ = Image<std::uint8_t>(width, height);
  written_ = {};
  for (Memory& memory : memories_) memory = {camera_mask_, {}, {}};
  finder_.reserve(width, height);
}

/// True if `hands` are where they were sought in this image before, so that the masks are the same.
/// Their bounds are capsules, which hardly ever decide a pixel: the light does.
bool HandMask::was_found(const TimedImage& camera, std::span<const Sought> hands) const {
  constexpr float kHardly_px = 0.25f;
  if (camera.id != image_.id || camera.origin_ns != image_.origin_ns ||
      camera.view.data != image_.view.data)
    return false;
  return std::ranges::equal(hands, sought_, [](const Sought& now, const Sought& before) {
    if (now.side != before.side || now.has_landmarks != before.has_landmarks ||
        now.then.has_value() != before.then.has_value())
      return false;
    if (!now.then) return true;
    const LandmarkPoints here = sum(now.then->landmarks, now.offset_px),
                         there = sum(before.then->landmarks, before.offset_px);
    return std::ranges::equal(
        here, there, [](glm::vec2 a, glm::vec2 b) { return glm::distance(a, b) < kHardly_px; });
  });
}

void HandMask::find(const TimedImage& camera, std::span<const Sought> hands) {
  if (was_found(camera, hands)) {
    for (std::size_t h = 0; h < hands.size(); ++h)
      if (hands[h].then) found_[h].then = hands[h].then->landmarks;
    return;
  }
  image_ = camera;
  sought_.assign(hands.begin(), hands.end());
  set_size(camera.view.width, camera.view.height);
  fill_rect(camera_mask_, written_, 0);
  owned_hints_.clear();
  hints_.clear();
  std::array<std::optional<std::size_t>, msg::kMaxHands> hint_of;
  for (std::size_t h = 0; h < hands.size(); ++h) {
    if (!hands[h].then) continue;
    auto hint = make_hint(calibration_, settings_, *hands[h].then, hands[h].offset_px,
                          hands[h].has_landmarks);
    if (!hint) continue;
    hint_of[h] = owned_hints_.size();
    owned_hints_.push_back(*hint);
  }
  for (const OwnedHint& owned : owned_hints_) hints_.push_back(owned.hint());
  written_ = finder_.find(camera.view, hints_, camera_mask_.view());
  found_.clear();
  for (std::size_t h = 0; h < hands.size(); ++h) {
    const auto& [side, then, offset_px, has_landmarks] = hands[h];
    Found& found = found_.emplace_back(Found{.side = side});
    if (then) found.then = then->landmarks;
    if (const auto& hint = hint_of[h]) {
      found.bounds = finder_.hand_bounds(*hint);
      found.is_shown = is_shown(found.bounds, memory_of(side).found, owned_hints_[*hint].seeds_px);
    }
    if (found.is_shown) remember(hands[h], found.bounds);
  }
}

bool HandMask::is_shown(const Rect& found, const Rect& before,
                        std::span<const glm::vec2> seeds_px) const {
  if (found.empty()) return false;
  if (area_of(found) * kGoodPart >= area_of(before)) return true;
  return std::ranges::any_of(seeds_px, [&](const glm::vec2& seed) {
    const auto x = static_cast<int>(std::lround(seed.x)), y = static_cast<int>(std::lround(seed.y));
    return x >= found.x0 && x < found.x1 && y >= found.y0 && y < found.y1 &&
           camera_mask_.at(x, y) != 0;
  });
}

void HandMask::remember(const Sought& hand, const Rect& found) {
  Memory& memory = memory_of(hand.side);
  fill_rect(memory.mask, memory.found, 0);
  memory.found = found.within(camera_mask_.width(), camera_mask_.height());
  for (int y = memory.found.y0; y < memory.found.y1; ++y)
    std::memcpy(memory.mask.row(y) + memory.found.x0, camera_mask_.row(y) + memory.found.x0,
                static_cast<std::size_t>(memory.found.width()));
  memory.landmarks = in_image(sum(hand.then->landmarks, hand.offset_px));
}

LandmarkPoints HandMask::in_image(LandmarkPoints undistorted_px) const {
  for (glm::vec2& point : undistorted_px) point = calibration_.camera.distort(point);
  return undistorted_px;
}

/// Maps image positions on the hand at the target time to those at the exposure.
Similarity HandMask::since_exposure(const Found& found, const Moved& hand) const {
  if (!found.then || !settings_.advance) return {};
  return fit_similarity(in_image(sum(hand.tracker, hand.moved_now)),
                        in_image(sum(*found.then, hand.moved_then)));
}

/// Maps image positions on the hand at the target time to those when it was last shown. No image
/// has been registered since, so the motion is that of the landmarks.
Similarity HandMask::since_seen(const Found& found, const Moved& hand) const {
  return settings_.advance
             ? fit_similarity(in_image(hand.landmarks), memory_of(found.side).landmarks)
             : Similarity{};
}

/// Where hand `h`, which fills `image_region` at the target time, falls in the projector. Sets its
/// nearness if the projector is not coaxial.
Rect HandMask::region_of(std::size_t h, const Moved& hand, const Rect& image_region) {
  const Rect screen{0, 0, projector_mask_.width(), projector_mask_.height()};
  if (calibration_.projector.parallax == glm::dvec3(0))
    return lookup_.to_projector(image_region).within(screen.x1, screen.y1);
  auto& nearness = nearness_[h];
  nearness.set(hand.projected_px, hand.depths_m, calibration_.projector.plane_m);
  return lookup_.to_projector(image_region, nearness.least())
      .joined(lookup_.to_projector(image_region, nearness.most()))
      .within(screen.x1, screen.y1);
}

Rect HandMask::advance(std::span<const Moved> hands) {
  Rect all;
  std::array<Rect, msg::kMaxHands> regions;
  std::array<Similarity, msg::kMaxHands> moves;
  for (std::size_t h = 0; h < hands.size(); ++h) {
    const Found& found = found_[h];
    moves[h] = found.is_shown ? since_exposure(found, hands[h]) : since_seen(found, hands[h]);
    const Rect bounds = found.is_shown ? found.bounds : memory_of(found.side).found;
    const bool dark = bounds.empty() || hands[h].presence <= 0;
    const Rect moved = dark ? Rect{} : moved_back(bounds, moves[h]).grown(kMargin_px);
    regions[h] = region_of(h, hands[h], moved);
    all = all.joined(regions[h]);
  }
  if (hands.size() > 1) fill_rect(projector_mask_, all, 0);
  for (const bool shown : {false, true})
    for (std::size_t h = 0; h < hands.size(); ++h) {
      if (found_[h].is_shown != shown) continue;
      const GreyView mask = shown ? camera_mask_.view() : memory_of(found_[h].side).mask.view();
      lookup_.resample(mask, regions[h], projector_mask_.view(), moves[h], nearness_[h].points());
    }
  return all;
}

}  // namespace handcast::renderer
