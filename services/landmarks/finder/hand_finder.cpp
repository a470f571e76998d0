// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/hand_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ipc/base/clock.hpp"

namespace handcast::landmarks {
namespace {

constexpr float kLeastRegion_px = 1;
constexpr float kItsHint =
    0.35f;  ///< how far off a tracker's hand may be to be this one, in regions
constexpr float kSameHand = 0.35f;  ///< mean distance of the points, in palm lengths
constexpr std::int64_t kForget_ns =
    300'000'000;  ///< a hand that was last seen longer ago may be anywhere
constexpr int kSearchEvery = 4, kSearchForMoreEvery = 60;  ///< images
constexpr float kLeftScoreShare = 0.1f, kSureOfSide = 0.25f;
constexpr int kAskSideEvery = 8;  ///< images, of a network that cannot tell it

msg::Side other(msg::Side side) {
  return side == msg::Side::left ? msg::Side::right : msg::Side::left;
}
std::size_t index_of(msg::Side side) { return static_cast<std::size_t>(side); }

bool is_usable(const std::optional<Points>& hint_px) { return hint_px && is_finite(*hint_px); }
bool any(const Hints& hints_px) { return std::ranges::any_of(hints_px, is_usable); }

bool are_one_hand(const Points& a, const Points& b) {
  return distance_px(a, b) < kSameHand * std::max(palm_length_px(a), palm_length_px(b));
}

/// Whether anything of it can lie in the image.
bool touches(const Region& region, renderer::GreyView image) {
  const glm::vec2 nearest =
      glm::clamp(region.centre_px, glm::vec2(0), glm::vec2(image.width - 1, image.height - 1));
  return glm::distance(nearest, region.centre_px) < 0.71f * region.size_px;
}

Points moved(Points points_px, glm::vec2 by_px) {
  for (auto& point : points_px) point += by_px;
  return points_px;
}

float sum_of(const std::array<float, msg::kLandmarks>& sigma_px) {
  return std::accumulate(sigma_px.begin(), sigma_px.end(), 0.0f);
}

/// As a share of the region.
float sigma_of(const FoundHand& hand) { return sum_of(hand.sigma_px) / hand.region.size_px; }

}  // namespace

Result<HandFinder> HandFinder::open(const std::string& backend, const std::filesystem::path& models,
                                    int most_hands) {
  auto hand = HandNetwork::open(backend, models);
  if (!hand) return tl::make_unexpected(hand.error());
  auto palm = PalmNetwork::open(backend, models);
  if (!palm) return tl::make_unexpected(palm.error());
  return HandFinder(std::make_unique<HandNetwork>(std::move(*hand)), std::move(*palm), most_hands);
}

Result<std::span<const FoundHand>> HandFinder::find(renderer::GreyView image, const Hints& hints_px,
                                                    std::int64_t time_ns) {
  times_ = {};
  const std::int64_t begin_ns = now_ns();
  found_.clear();
  left_scores_.clear();
  if (palm_ || any(hints_px))
    std::erase_if(tracks_,
                  [&](const Track& track) { return time_ns - track.seen_ns > kForget_ns; });
  choose_candidates(hints_px);
  for (auto& candidate : candidates_) {
    if (found_.size() == static_cast<std::size_t>(most_hands_)) break;
    if (is_found(candidate.side)) candidate.side = other(candidate.side);
    const bool either =
        !candidate.hint_px && !candidate.is_followed && !hand_->tells_sides() && found_.empty();
    const auto looked =
        either ? look_for_either_side(image, candidate.region) : look(image, candidate);
    if (!looked) return tl::make_unexpected(looked.error());
  }
  drop_double(hints_px);
  if (search_is_due(hints_px)) {
    if (const auto searched = search(image); !searched)
      return tl::make_unexpected(searched.error());
  }
  settle_sides(hints_px);
  remember(hints_px, time_ns);
  times_.all_ns = now_ns() - begin_ns;
  return std::span<const FoundHand>(found_);
}

void HandFinder::forget() {
  tracks_.clear();
  since_search_ = kLongAgo;
}

/// The followed hand that the tracker's hand of this side is: the one of the same side if it is
/// near, else the nearest.
std::optional<std::size_t> HandFinder::track_of(msg::Side side, const Points& hint_px) const {
  std::optional<std::size_t> best;
  float best_distance = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Points& before_px = tracks_[i].hint_px.value_or(tracks_[i].points_px);
    const float distance = glm::distance(centre_of(before_px), centre_of(hint_px));
    if (distance > 0.5f * hand_->region_around(tracks_[i].points_px).size_px) continue;
    if (tracks_[i].side == side) return i;
    if (!best || distance < best_distance) best = i, best_distance = distance;
  }
  return best;
}

std::optional<Points> HandFinder::if_near(const std::optional<Points>& hint_px,
                                          const Points& points_px) const {
  if (!is_usable(hint_px)) return std::nullopt;
  const float distance = glm::distance(centre_of(*hint_px), centre_of(points_px));
  return distance < kItsHint * hand_->region_around(points_px).size_px ? hint_px : std::nullopt;
}

bool HandFinder::is_found(msg::Side side) const {
  return std::ranges::any_of(found_, [&](const FoundHand& hand) { return hand.side == side; });
}

/// First the hands that the tracker has and that were seen there, then where it has others, then
/// those that only the image knows.
void HandFinder::choose_candidates(const Hints& hints_px) {
  candidates_.clear();
  std::array<bool, msg::kMaxHands> followed{};
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto& hint_px = hints_px[index_of(side)];
    if (!is_usable(hint_px)) continue;
    const auto track = track_of(side, *hint_px);
    if (!track || followed[*track] || !tracks_[*track].steady) {
      if (track) followed[*track] = true;
      candidates_.push_back({side, hand_->region_around(*hint_px), hint_px});
      continue;
    }
    followed[*track] = true;
    const Track& seen = tracks_[*track];
    const glm::vec2 step_px =
        seen.hint_px ? centre_of(*hint_px) - centre_of(*seen.hint_px) : glm::vec2(0);
    const Points around_px = moved(seen.around_px, step_px);
    candidates_.push_back({side, hand_->region_around(around_px), if_near(hint_px, around_px), true,
                           seen.left_score});
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (followed[i]) continue;
    const Track& seen = tracks_[i];
    candidates_.push_back({seen.side, hand_->region_around(seen.points_px), std::nullopt,
                           seen.steady, seen.left_score});
  }
  std::stable_partition(candidates_.begin(), candidates_.end(), [](const Candidate& candidate) {
    return candidate.is_followed && candidate.hint_px;
  });
}

/// Sets `region`: where it was looked for last.
Result<LandmarkModel::Seen> HandFinder::look_at(renderer::GreyView image,
                                                const Candidate& candidate, Region& region) {
  LandmarkModel::Seen seen;
  const int looks = candidate.is_followed ? 1 : hand_->first_looks();
  for (int i = 0; i < looks; ++i) {
    region = i == 0 ? candidate.region : hand_->region_around(seen.points_px);
    if (!(region.size_px >= kLeastRegion_px) || !touches(region, image))
      return LandmarkModel::Seen{};
    auto answer = look_once(image, region, candidate.side, candidate.hint_px);
    if (!answer) return answer;
    seen = *answer;
  }
  return seen;
}

Result<LandmarkModel::Seen> HandFinder::look_once(renderer::GreyView image, const Region& region,
                                                  msg::Side side,
                                                  const std::optional<Points>& hint_px) {
  LandmarkModel::Times times;
  auto seen = hand_->look(image, region, side, hint_px, times);
  ++times_.looks;
  times_.crop_ns += times.crop_ns;
  times_.network_ns += times.network_ns;
  return seen;
}

Result<void> HandFinder::look(renderer::GreyView image, const Candidate& candidate) {
  Region region;
  const auto seen = look_at(image, candidate, region);
  if (!seen) return tl::make_unexpected(seen.error());
  if (seen->presence < kLeastPresence || !is_finite(seen->points_px)) return {};
  const Confidences confidences = confidences_of(*seen, region, candidate.hint_px);
  if (mean_of(confidences) < kLeastConfidence) return {};
  found_.push_back(
      {candidate.side, seen->presence, seen->points_px, region, seen->sigma_px, confidences});
  const float before = candidate.left_score < 0 ? seen->left_score : candidate.left_score;
  const bool asks = candidate.is_followed && !candidate.hint_px && !hand_->tells_sides();
  const Result<float> told =
      asks ? left_score_of(image, candidate, found_.back()) : Result<float>(seen->left_score);
  if (!told) return tl::make_unexpected(told.error());
  left_scores_.push_back(before + kLeftScoreShare * (*told - before));
  return {};
}

/// Of a network that is told the side and is surer of the right one: now and then, whether it would
/// be surer of the other.
Result<float> HandFinder::left_score_of(renderer::GreyView image, const Candidate& candidate,
                                        const FoundHand& hand) {
  if (++since_side_ < kAskSideEvery) return candidate.left_score;
  since_side_ = 0;
  const auto mirrored = look_once(image, hand.region, other(hand.side), std::nullopt);
  if (!mirrored) return tl::make_unexpected(mirrored.error());
  const bool is_so = sum_of(hand.sigma_px) <= sum_of(mirrored->sigma_px);
  return is_so == (hand.side == msg::Side::left) ? 1.0f : 0.0f;
}

/// Two looks that ended on one hand: the one stays that lies nearer to its own joints of the
/// tracker, or is the surer one.
void HandFinder::drop_double(const Hints& hints_px) {
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
  left_scores_.erase(left_scores_.begin() + (keep_first ? 1 : 0));
}

/// Where no hand was found: every few images. For one more hand: seldom, and not while there is a
/// tracker, which would know.
bool HandFinder::search_is_due(const Hints& hints_px) {
  ++since_search_;
  if (!palm_) return false;
  if (found_.empty()) return since_search_ >= kSearchEvery;
  return !any(hints_px) && found_.size() < static_cast<std::size_t>(most_hands_) &&
         since_search_ >= kSearchForMoreEvery;
}

Result<void> HandFinder::search(renderer::GreyView image) {
  since_search_ = 0;
  ++times_.searches;
  const std::int64_t begin_ns = now_ns();
  const auto regions = palm_->search(image);
  times_.palm_ns = now_ns() - begin_ns;
  if (!regions) return tl::make_unexpected(regions.error());
  for (const auto& region : *regions) {
    if (found_.size() >= static_cast<std::size_t>(most_hands_)) break;
    const std::size_t before = found_.size();
    if (auto looked = look_for_either_side(image, region); !looked) return looked;
    if (found_.size() == before) continue;
    drop_double({});
    if (found_.size() == 2 && found_[0].side == found_[1].side)
      found_[1].side = other(found_[0].side);
  }
  return {};
}

/// By the network's word; of one that cannot tell, by which side it is surer of.
Result<void> HandFinder::look_for_either_side(renderer::GreyView image, const Region& region) {
  const std::size_t before = found_.size();
  if (auto looked = look(image, {msg::Side::left, region, std::nullopt}); !looked) return looked;
  if (hand_->tells_sides()) {
    if (found_.size() > before)
      found_.back().side = left_scores_.back() >= 0.5f ? msg::Side::left : msg::Side::right;
    return {};
  }
  if (auto looked = look(image, {msg::Side::right, region, std::nullopt}); !looked) return looked;
  if (found_.size() < before + 2) return {};
  const bool is_left = sigma_of(found_[before]) <= sigma_of(found_[before + 1]);
  found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(before + (is_left ? 1 : 0)));
  left_scores_.pop_back();
  return {};
}

/// A hand that the tracker does not know changes its side where the network says so for long, and
/// that side is free.
void HandFinder::settle_sides(const Hints& hints_px) {
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (is_usable(hints_px[index_of(found_[i].side)])) continue;
    const float score = left_scores_[i] - 0.5f;
    const auto seen = score > 0 ? msg::Side::left : msg::Side::right;
    if (std::abs(score) < kSureOfSide || seen == found_[i].side ||
        is_usable(hints_px[index_of(seen)]))
      continue;
    if (found_.size() == 1) found_[i].side = seen;
  }
}

/// A hand that was not found is kept for a while: the next image may be a better one.
void HandFinder::remember(const Hints& hints_px, std::int64_t time_ns) {
  std::erase_if(tracks_, [&](const Track& track) {
    return std::ranges::any_of(found_, [&](const FoundHand& hand) {
      return hand.side == track.side || are_one_hand(hand.points_px, track.points_px);
    });
  });
  for (auto& track : tracks_) track.steady = false;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const auto hint_px = if_near(hints_px[index_of(found_[i].side)], found_[i].points_px);
    const bool steady = mean_of(found_[i].confidences) >= kSteadyConfidence;
    Track track{found_[i].side, found_[i].points_px, found_[i].points_px,
                hint_px,        left_scores_[i],     time_ns,
                steady};
    if (hint_px) {
      for (std::size_t k = 0; k < track.around_px.size(); ++k)
        if (found_[i].confidences[k] < kSureConfidence) track.around_px[k] = (*hint_px)[k];
    }
    tracks_.push_back(track);
  }
}

}  // namespace handcast::landmarks
