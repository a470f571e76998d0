// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "services/landmarks/finder/hand_finder.hpp"

namespace handcast::landmarks {
namespace {

constexpr float kItsHint = 0.35f;   ///< largest distance of a hand from its hint, in region sides
constexpr float kSameHand = 0.35f;  ///< largest mean distance of the points, in palm lengths
constexpr float kSureConfidence = 0.5f;  ///< of one landmark
constexpr std::int64_t kForget_ns = 300'000'000;

/// The hint if it is near enough to belong to the hand at these points; otherwise empty.
std::optional<Points> if_near(const std::optional<Points>& hint_px, const Points& points_px,
                              const LandmarkModel& model) {
  if (!is_usable(hint_px)) return std::nullopt;
  const float distance = glm::distance(centre_of(*hint_px), centre_of(points_px));
  return distance < kItsHint * model.region_around(points_px).size_px ? hint_px : std::nullopt;
}

}  // namespace

bool is_usable(const std::optional<Points>& hint_px) { return hint_px && is_finite(*hint_px); }

bool are_one_hand(const Points& a, const Points& b) {
  return distance_px(a, b) < kSameHand * std::max(palm_length_px(a), palm_length_px(b));
}

/// The track that the tracker's hand of this side belongs to: one of the same side if it is near,
/// otherwise the nearest.
std::optional<std::size_t> HandTracks::track_of(msg::Side side, const Points& hint_px,
                                                const LandmarkModel& model) const {
  std::optional<std::size_t> best;
  float best_distance = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Points& before_px = tracks_[i].hint_px.value_or(tracks_[i].points_px);
    const float distance = glm::distance(centre_of(before_px), centre_of(hint_px));
    if (distance > 0.5f * model.region_around(tracks_[i].points_px).size_px) continue;
    if (tracks_[i].side == side) return i;
    if (!best || distance < best_distance) best = i, best_distance = distance;
  }
  return best;
}

/// A hand of the last image, moved on as the tracker's hand has moved since.
HandCandidate HandTracks::followed(const Track& track, msg::Side side, const Points& hint_px,
                                   const LandmarkModel& model) const {
  const glm::vec2 step_px =
      track.hint_px ? centre_of(hint_px) - centre_of(*track.hint_px) : glm::vec2(0);
  const Points around_px = shifted(track.around_px, step_px);
  return {side,
          model.region_around(around_px),
          if_near(hint_px, around_px, model),
          true,
          track.left_score,
          std::nullopt,
          track.comparisons};
}

std::span<HandCandidate> HandTracks::candidates(const Hints& hints_px, const LandmarkModel& model) {
  candidates_.clear();
  std::array<bool, msg::kMaxHands> has_hint{};
  for (const auto side : {msg::Side::left, msg::Side::right}) {
    const auto& hint_px = hints_px[index_of(side)];
    if (!is_usable(hint_px)) continue;
    const auto track = track_of(side, *hint_px, model);
    if (track && !has_hint[*track] && tracks_[*track].steady)
      candidates_.push_back(followed(tracks_[*track], side, *hint_px, model));
    else
      candidates_.push_back({side, model.region_around(*hint_px), hint_px});
    if (track) has_hint[*track] = true;
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    if (!has_hint[i])
      candidates_.push_back({tracks_[i].side, model.region_around(tracks_[i].points_px),
                             std::nullopt, tracks_[i].steady, tracks_[i].left_score,
                             tracks_[i].points_px, tracks_[i].comparisons});
  std::stable_partition(candidates_.begin(), candidates_.end(), [](const HandCandidate& candidate) {
    return candidate.is_followed && candidate.hint_px;
  });
  return candidates_;
}

void HandTracks::remember(std::span<const FoundHand> found, const Hints& hints_px,
                          const LandmarkModel& model, std::int64_t time_ns) {
  std::erase_if(tracks_, [&](const Track& track) {
    return std::ranges::any_of(found, [&](const FoundHand& hand) {
      return hand.side == track.side || are_one_hand(hand.points_px, track.points_px);
    });
  });
  for (auto& track : tracks_) track.steady = false;
  for (const auto& hand : found) {
    const auto hint_px = if_near(hints_px[index_of(hand.side)], hand.points_px, model);
    const bool steady = mean_of(hand.confidences) >= kSteadyConfidence;
    Track track{hand.side,       hand.points_px, hand.points_px,   hint_px,
                hand.left_score, time_ns,        hand.comparisons, steady};
    if (hint_px) {
      for (std::size_t k = 0; k < track.around_px.size(); ++k)
        if (hand.confidences[k] < kSureConfidence) track.around_px[k] = (*hint_px)[k];
    }
    tracks_.push_back(track);
  }
}

void HandTracks::drop_old(std::int64_t time_ns) {
  std::erase_if(tracks_, [&](const Track& track) { return time_ns - track.found_ns > kForget_ns; });
}

}  // namespace handcast::landmarks
