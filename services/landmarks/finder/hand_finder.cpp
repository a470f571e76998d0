// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/hand_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ipc/base/clock.hpp"

namespace handcast::landmarks {
namespace {

constexpr float kLeastRegion_px = 1;
constexpr int kSearchEvery = 4, kSearchForMoreEvery = 60;  ///< images
constexpr float kLeftScoreShare = 0.1f;                    ///< of a new image in the running mean
constexpr float kSureOfSide = 0.25f;                       ///< distance of a left score from 0.5
constexpr int kCompareSidesEvery = 8;  ///< images, with a model that does not score sides

msg::Side other(msg::Side side) {
  return side == msg::Side::left ? msg::Side::right : msg::Side::left;
}
std::size_t index_of(msg::Side side) { return static_cast<std::size_t>(side); }

bool any(const Hints& hints_px) { return std::ranges::any_of(hints_px, is_usable); }

/// True if a part of the region may lie in the image.
bool touches(const Region& region, renderer::GreyView image) {
  const glm::vec2 nearest =
      glm::clamp(region.centre_px, glm::vec2(0), glm::vec2(image.width - 1, image.height - 1));
  return glm::distance(nearest, region.centre_px) < 0.71f * region.size_px;
}

float sum_of(const std::array<float, msg::kLandmarks>& sigma_px) {
  return std::accumulate(sigma_px.begin(), sigma_px.end(), 0.0f);
}

/// The sum of the sigmas relative to the region's side.
float sigma_of(const FoundHand& hand) { return sum_of(hand.sigma_px) / hand.region.size_px; }

}  // namespace

Result<std::span<const FoundHand>> HandFinder::find(renderer::GreyView image, const Hints& hints_px,
                                                    std::int64_t time_ns) {
  times_ = {};
  const std::int64_t begin_ns = now_ns();
  found_.clear();
  if (model_.palms || any(hints_px)) tracks_.drop_old(time_ns);
  const bool scores_sides = model_.landmarks->traits().scores_sides;
  for (auto& candidate : tracks_.candidates(hints_px, *model_.landmarks)) {
    if (has_most()) break;
    if (is_found(candidate.side)) candidate.side = other(candidate.side);
    const bool either =
        !candidate.hint_px && !candidate.is_followed && !scores_sides && found_.empty();
    const auto examined =
        either ? examine_either_side(image, candidate.region) : examine(image, candidate);
    if (!examined) return tl::make_unexpected(examined.error());
  }
  drop_duplicate(hints_px);
  if (search_is_due(hints_px)) {
    if (const auto searched = search(image); !searched)
      return tl::make_unexpected(searched.error());
  }
  settle_sides(hints_px);
  tracks_.remember(found_, hints_px, *model_.landmarks, time_ns);
  times_.all_ns = now_ns() - begin_ns;
  return std::span<const FoundHand>(found_);
}

void HandFinder::forget() {
  tracks_.clear();
  since_search_ = kLongAgo;
}

bool HandFinder::is_found(msg::Side side) const {
  return std::ranges::any_of(found_, [&](const FoundHand& hand) { return hand.side == side; });
}

/// Estimates a candidate and adds it to the found hands if it is a hand.
Result<void> HandFinder::examine(renderer::GreyView image, const HandCandidate& candidate) {
  Region region;
  const auto hand = estimate(image, candidate, region);
  if (!hand) return tl::make_unexpected(hand.error());
  if (hand->presence < kLeastPresence || !is_finite(hand->points_px)) return {};
  const Confidences confidences = confidences_of(*hand, region, candidate.hint_px);
  if (mean_of(confidences) < kLeastConfidence) return {};
  found_.push_back({candidate.side, hand->presence, hand->points_px, region, hand->sigma_px,
                    confidences, hand->left_score});
  const float before = candidate.left_score < 0 ? hand->left_score : candidate.left_score;
  const auto now = left_score_of(image, candidate, found_.back());
  if (!now) return tl::make_unexpected(now.error());
  found_.back().left_score = before + kLeftScoreShare * (*now - before);
  return {};
}

/// Estimates the candidate in one or more passes and returns the last estimate. Sets `region` to
/// its part of the image.
Result<LandmarkEstimate> HandFinder::estimate(renderer::GreyView image,
                                              const HandCandidate& candidate, Region& region) {
  LandmarkEstimate last;
  const int passes = candidate.is_followed ? 1 : model_.landmarks->traits().passes_at_first;
  for (int i = 0; i < passes; ++i) {
    region = i == 0 ? candidate.region : model_.landmarks->region_around(last.points_px);
    if (!(region.size_px >= kLeastRegion_px) || !touches(region, image)) return LandmarkEstimate{};
    auto next = run_model(image, region, candidate.side, candidate.hint_px);
    if (!next) return next;
    last = *next;
  }
  return last;
}

Result<LandmarkEstimate> HandFinder::run_model(renderer::GreyView image, const Region& region,
                                               msg::Side side,
                                               const std::optional<Points>& hint_px) {
  EstimateTimes times;
  auto estimate = model_.landmarks->estimate(image, region, side, hint_px, times);
  ++times_.model_runs;
  times_.crop_ns += times.crop_ns;
  times_.network_ns += times.network_ns;
  return estimate;
}

/// The left score of a hand in this image. A model that does not score sides is run on the mirrored
/// hand, too, every few images: the smaller sigma decides.
Result<float> HandFinder::left_score_of(renderer::GreyView image, const HandCandidate& candidate,
                                        const FoundHand& hand) {
  if (!candidate.is_followed || candidate.hint_px || model_.landmarks->traits().scores_sides)
    return hand.left_score;
  if (++since_side_ < kCompareSidesEvery) return candidate.left_score;
  since_side_ = 0;
  const auto mirrored = run_model(image, hand.region, other(hand.side), std::nullopt);
  if (!mirrored) return tl::make_unexpected(mirrored.error());
  const bool is_right_side = sum_of(hand.sigma_px) <= sum_of(mirrored->sigma_px);
  return is_right_side == (hand.side == msg::Side::left) ? 1.0f : 0.0f;
}

/// Two candidates may have the same hand as their result. Keeps the one that is nearer to its hint
/// or, without hints, has the larger presence.
void HandFinder::drop_duplicate(const Hints& hints_px) {
  if (found_.size() < 2) return;
  if (!are_one_hand(found_[0].points_px, found_[1].points_px)) return;
  const auto& first = hints_px[index_of(found_[0].side)];
  const auto& second = hints_px[index_of(found_[1].side)];
  bool keep_first = found_[0].presence >= found_[1].presence;
  if (is_usable(first) != is_usable(second)) keep_first = is_usable(first);
  if (is_usable(first) && is_usable(second))
    keep_first =
        distance_px(*first, found_[0].points_px) <= distance_px(*second, found_[1].points_px);
  found_.erase(found_.begin() + (keep_first ? 1 : 0));
}

/// Without a hand, one in a few images is searched. With one hand, images are searched for a second
/// one rarely, and only without a tracker, because the tracker would report it.
bool HandFinder::search_is_due(const Hints& hints_px) {
  ++since_search_;
  if (!model_.palms) return false;
  if (found_.empty()) return since_search_ >= kSearchEvery;
  return !any(hints_px) && !has_most() && since_search_ >= kSearchForMoreEvery;
}

Result<void> HandFinder::search(renderer::GreyView image) {
  since_search_ = 0;
  ++times_.palm_runs;
  const std::int64_t begin_ns = now_ns();
  const auto regions = model_.palms->search(image);
  times_.palm_ns = now_ns() - begin_ns;
  if (!regions) return tl::make_unexpected(regions.error());
  for (const auto& region : *regions) {
    if (has_most()) break;
    const std::size_t before = found_.size();
    if (auto examined = examine_either_side(image, region); !examined) return examined;
    if (found_.size() == before) continue;
    drop_duplicate({});
    if (found_.size() == 2 && found_[0].side == found_[1].side)
      found_[1].side = other(found_[0].side);
  }
  return {};
}

/// Examines a region that may hold a left or a right hand. The model's score decides; if it has
/// none, the side with the smaller sigma.
Result<void> HandFinder::examine_either_side(renderer::GreyView image, const Region& region) {
  const std::size_t before = found_.size();
  if (auto examined = examine(image, {msg::Side::left, region, std::nullopt}); !examined)
    return examined;
  if (model_.landmarks->traits().scores_sides) {
    if (found_.size() > before)
      found_.back().side = found_.back().left_score >= 0.5f ? msg::Side::left : msg::Side::right;
    return {};
  }
  if (auto examined = examine(image, {msg::Side::right, region, std::nullopt}); !examined)
    return examined;
  if (found_.size() < before + 2) return {};
  const bool is_left = sigma_of(found_[before]) <= sigma_of(found_[before + 1]);
  found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(before + (is_left ? 1 : 0)));
  return {};
}

/// Changes the side of a hand that the tracker does not have, if its mean left score clearly
/// contradicts it and there is no other hand of the new side.
void HandFinder::settle_sides(const Hints& hints_px) {
  for (auto& hand : found_) {
    if (is_usable(hints_px[index_of(hand.side)])) continue;
    const float score = hand.left_score - 0.5f;
    const auto likely = score > 0 ? msg::Side::left : msg::Side::right;
    if (std::abs(score) < kSureOfSide || likely == hand.side ||
        is_usable(hints_px[index_of(likely)]))
      continue;
    if (found_.size() == 1) hand.side = likely;
  }
}

}  // namespace handcast::landmarks
