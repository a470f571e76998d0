// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/steady_hints.hpp"

#include <algorithm>

namespace handcast::landmarks {
namespace {

/// A joint that is farther off than this many palm lengths is left where it is: the tracker may be
/// right, and what was found may not be a hand.
constexpr float kMost = 0.15f;

}  // namespace

Points SteadyHints::steadied(msg::Side side, Points hint_px) const {
  const float most_px = kMost * palm_length_px(hint_px);
  const Points& passing_px = hands_[static_cast<std::size_t>(side)].passing_px;
  for (std::size_t i = 0; i < hint_px.size(); ++i)
    if (glm::length(passing_px[i]) <= most_px) hint_px[i] -= passing_px[i];
  return hint_px;
}

void SteadyHints::remember(std::span<const FoundHand> found, const Hints& hints_px,
                           std::int64_t time_ns) {
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    const auto hand = std::ranges::find_if(
        found, [&](const FoundHand& each) { return static_cast<std::size_t>(each.side) == h; });
    if (hand == found.end() || !hints_px[h]) {
      hands_[h] = Hand();
      continue;
    }
    for (std::size_t i = 0; i < msg::kLandmarks; ++i) {
      const glm::vec2 at_px = hand->points_px[i], distance_px = (*hints_px[h])[i] - at_px;
      hands_[h].passing_px[i] =
          distance_px - hands_[h].distances[i].add(time_ns, distance_px, at_px);
    }
  }
}

}  // namespace handcast::landmarks
