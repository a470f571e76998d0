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
constexpr float kClearSide = 1.3f;                         ///< quotient of the sigmas of both sides
constexpr float kStartOfSide = 1.5f;      ///< the mean begins with so many: two clear ones turn it
constexpr float kLeastDirection = 0.15f;  ///< confidence of a hand in a region that was guessed
constexpr int kCompareSidesEvery = 8;     ///< images, with a model that does not score sides
// Without a tracker, by time: for a while, a left hand's back looks like a right one's palm.
constexpr std::int64_t kCompareSidesEvery_ns = 25'000'000, kSideMemory_ns = 1'500'000'000;

msg::Side other(msg::Side side) {
  return side == msg::Side::left ? msg::Side::right : msg::Side::left;
}
bool any(const Hints& hints_px) { return std::ranges::any_of(hints_px, is_usable); }

/// True if a part of the region may lie in the image.
bool touches(const Region& region, renderer::GreyView image) {
  const glm::vec2 nearest =
      glm::clamp(region.centre_px, glm::vec2(0), glm::vec2(image.width - 1, image.height - 1));
  return glm::distance(nearest, region.centre_px) < 0.71f * region.size_px;
}

/// True if wrist and middle knuckle of both are at one place: a hand and its mirrored reading, in
/// which thumb and little finger are exchanged.
bool have_one_palm(const Points& a, const Points& b) {
  constexpr float kSamePalm = 0.3f;  // in palm lengths
  const float most_px = kSamePalm * std::max(palm_length_px(a), palm_length_px(b));
  return glm::distance(a[0], b[0]) < most_px && glm::distance(a[9], b[9]) < most_px;
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
  image_ns_ = time_ns;
  const std::int64_t begin_ns = now_ns();
  found_.clear();
  if (can_search() || any(hints_px)) tracks_.drop_old(time_ns);
  const bool scores_sides = model_.landmarks->traits().scores_sides;
  for (auto& candidate : tracks_.candidates(hints_px, *model_.landmarks)) {
    if (has_most()) break;
    if (is_found(candidate.side)) candidate.side = other(candidate.side);
    const bool is_known = lifts_ && candidate.left_score >= 0;
    const bool either = !candidate.hint_px && !candidate.is_followed && !scores_sides &&
                        found_.empty() && !is_known;
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
  steady_hints_.remember(found_, hints_px, time_ns);
  times_.all_ns = now_ns() - begin_ns;
  return std::span<const FoundHand>(found_);
}

void HandFinder::forget() {
  tracks_.clear();
  steady_hints_.forget();
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
  auto sigma_px = hand->sigma_px;
  if (const float usual = model_.landmarks->traits().usual_sigma; usual > 0 && !lifts_)
    sigma_px.fill(usual * region.size_px);
  found_.push_back({candidate.side, hand->presence, hand->points_px, region, sigma_px, confidences,
                    candidate.before_px, hand->left_score, candidate.comparisons});
  const auto left_score = left_score_of(image, candidate, found_.back());
  if (!left_score) return tl::make_unexpected(left_score.error());
  found_.back().left_score = *left_score;
  return {};
}

/// Estimates the candidate in one or more passes and returns the last estimate. Sets `region` to
/// its part of the image.
Result<LandmarkEstimate> HandFinder::estimate(renderer::GreyView image,
                                              const HandCandidate& candidate, Region& region) {
  LandmarkEstimate last;
  auto hint_px = candidate.hint_px;
  if (hint_px) hint_px = steady_hints_.steadied(candidate.side, *hint_px);
  const int passes = candidate.is_followed ? 1 : model_.landmarks->traits().passes_at_first;
  for (int i = 0; i < passes; ++i) {
    region = i == 0 ? candidate.region : model_.landmarks->region_around(last.points_px);
    if (!(region.size_px >= kLeastRegion_px) || !touches(region, image)) return LandmarkEstimate{};
    auto next = run_model(image, region, candidate.side, hint_px);
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

/// The mean left score of a hand, with this image. A model that does not score sides is run on the
/// mirrored hand, too, in some of the images: the smaller sigma decides, by how clearly it does.
Result<float> HandFinder::left_score_of(renderer::GreyView image, const HandCandidate& candidate,
                                        FoundHand& hand) {
  const float before = candidate.left_score < 0 ? hand.left_score : candidate.left_score;
  if (lifts_ && !candidate.is_followed) return before;
  if (!candidate.is_followed || candidate.hint_px || model_.landmarks->traits().scores_sides)
    return before + kLeftScoreShare * (hand.left_score - before);
  const float least = least_share_of_comparison(hand);
  if (least == 0) return before;
  const auto mirrored = run_model(image, hand.region, other(hand.side), std::nullopt);
  if (!mirrored) return tl::make_unexpected(mirrored.error());
  const float own = sum_of(hand.sigma_px), others = sum_of(mirrored->sigma_px);
  const float now = (own <= others) == (hand.side == msg::Side::left) ? 1.0f : 0.0f;
  const float clarity = std::min(1.0f, std::abs(std::log(own / others)) / std::log(kClearSide));
  hand.comparisons += clarity;
  const float share = std::max(least, lifts_ ? 1 / (kStartOfSide + hand.comparisons) : 0);
  return before + clarity * share * (now - before);
}

/// The least weight of a clear comparison of sides in the mean; 0 if none is due.
float HandFinder::least_share_of_comparison(const FoundHand& hand) {
  if (!lifts_) return ++since_side_ % kCompareSidesEvery == 0 ? kLeftScoreShare : 0.0f;
  std::int64_t& compared_ns = compared_ns_[index_of(hand.side)];
  const std::int64_t since_ns = image_ns_ - compared_ns;
  if (since_ns < kCompareSidesEvery_ns) return 0;
  compared_ns = image_ns_;
  const float by_time = static_cast<float>(since_ns) / static_cast<float>(kSideMemory_ns);
  return std::min(by_time, kLeftScoreShare);
}

/// Two candidates may have the same hand as their result, for example while hands cross. Keeps the
/// one that is nearer to its hint or, without hints, the one that has moved less since the last
/// image or, if that is not known, of which the model is surer. Where the tracker has only one hand
/// or none, a hand may have been read as a left and as a right one.
void HandFinder::drop_duplicate(const Hints& hints_px) {
  if (found_.size() < 2) return;
  const Points &a_px = found_[0].points_px, &b_px = found_[1].points_px;
  const auto& first = hints_px[index_of(found_[0].side)];
  const auto& second = hints_px[index_of(found_[1].side)];
  const bool both_are_known = is_usable(first) && is_usable(second);
  if (!are_one_hand(a_px, b_px) && (both_are_known || !have_one_palm(a_px, b_px))) return;
  const auto doubt = [](const auto& hand) { return std::pair(sigma_of(hand), -hand.presence); };
  bool keep_first = doubt(found_[0]) <= doubt(found_[1]);
  if (found_[0].before_px && found_[1].before_px)
    keep_first = distance_px(*found_[0].before_px, found_[0].points_px) <=
                 distance_px(*found_[1].before_px, found_[1].points_px);
  if (is_usable(first) != is_usable(second)) keep_first = is_usable(first);
  if (both_are_known) keep_first = distance_px(*first, a_px) <= distance_px(*second, b_px);
  found_.erase(found_.begin() + (keep_first ? 1 : 0));
}

/// Without a hand, one in a few images is searched. With one hand, images are searched for a second
/// one rarely, and not with a tracker of its own sensors, which would report it.
bool HandFinder::search_is_due(const Hints& hints_px) {
  ++since_search_;
  if (!can_search()) return false;
  if (found_.empty()) return since_search_ >= kSearchEvery;
  return (lifts_ || !any(hints_px)) && !has_most() && since_search_ >= kSearchForMoreEvery;
}

Result<void> HandFinder::search(renderer::GreyView image) {
  since_search_ = 0;
  const auto regions = regions_to_search(image);
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

Result<std::vector<Region>> HandFinder::regions_to_search(renderer::GreyView image) {
  if (!model_.palms) return search_bright(image);
  ++times_.palm_runs;
  const std::int64_t begin_ns = now_ns();
  auto regions = model_.palms->search(image);
  times_.palm_ns = now_ns() - begin_ns;
  return regions;
}

/// The regions of the bright parts that the model takes for hands.
Result<std::vector<Region>> HandFinder::search_bright(renderer::GreyView image) {
  const std::int64_t begin_ns = now_ns();
  std::vector<Points> known;
  for (const auto& hand : found_) known.push_back(hand.points_px);
  const auto bright = bright_hands_.search(image, known, places_);
  times_.palm_ns = now_ns() - begin_ns;
  std::vector<Region> regions;
  for (const BrightHand& hand : bright) {
    const auto region = best_direction(image, hand);
    if (!region) return tl::make_unexpected(region.error());
    if (*region) regions.push_back(**region);
  }
  return regions;
}

/// The region around the landmarks in the direction in which the model is the surest of them, of
/// one side or the other. Empty if it sees no hand in any direction.
Result<std::optional<Region>> HandFinder::best_direction(renderer::GreyView image,
                                                         const BrightHand& bright) {
  std::optional<Region> best;
  float most = kLeastDirection;
  for (const Region& region : bright.regions) {
    for (const auto side : {msg::Side::left, msg::Side::right}) {
      const auto seen = run_model(image, region, side, std::nullopt);
      if (!seen) return tl::make_unexpected(seen.error());
      if (seen->presence < kLeastPresence || !is_finite(seen->points_px)) continue;
      const float confidence = mean_of(confidences_of(*seen, region, std::nullopt));
      if (confidence <= most) continue;
      most = confidence;
      best = model_.landmarks->region_around(seen->points_px);
    }
    if (most >= kSteadyConfidence) break;
  }
  return best;
}

/// Examines a region that may hold a left or a right hand. The model's score decides; if it has
/// none, the side with the smaller sigma. If they are nearly equal, as where the region cuts the
/// hand off, the region of what was found decides.
Result<void> HandFinder::examine_either_side(renderer::GreyView image, const Region& region) {
  constexpr int kMostRegions = 4;
  const std::size_t before = found_.size();
  if (model_.landmarks->traits().scores_sides) {
    if (auto examined = examine(image, {msg::Side::left, region, std::nullopt}); !examined)
      return examined;
    if (found_.size() > before)
      found_.back().side = found_.back().left_score >= 0.5f ? msg::Side::left : msg::Side::right;
    return {};
  }
  Region seen = region;
  for (int i = 1;; ++i) {
    found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(before), found_.end());
    for (const auto side : {msg::Side::left, msg::Side::right})
      if (auto examined = examine(image, {side, seen, std::nullopt}); !examined) return examined;
    if (found_.size() < before + 2) return {};
    const float left = sigma_of(found_[before]), right = sigma_of(found_[before + 1]);
    found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(before + (left <= right ? 1 : 0)));
    const bool is_clear = std::max(left, right) >= kClearSide * std::min(left, right);
    if (is_clear || i == kMostRegions) return {};
    seen = model_.landmarks->region_around(found_.back().points_px);
  }
}

/// Changes the side of a hand that the tracker does not have, if its mean left score clearly
/// contradicts it and there is no other hand of the new side. Exchanges the sides of two hands
/// that both contradict theirs.
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
  if (found_.size() < 2 || any(hints_px)) return;
  const float first = found_[0].left_score, second = found_[1].left_score;
  const bool exchanged = found_[0].side == msg::Side::left ? second - first > 2 * kSureOfSide
                                                           : first - second > 2 * kSureOfSide;
  if (exchanged) std::swap(found_[0].side, found_[1].side);
}

}  // namespace handcast::landmarks
