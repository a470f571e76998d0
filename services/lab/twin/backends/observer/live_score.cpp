// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/backends/observer/live_score.hpp"

#include <nlohmann/json.hpp>

namespace handcast::observer {

static constexpr std::size_t kPointsPerHand = 300;

static std::size_t points(const twin::FrameScore::Hand& hand) {
  return hand.interior_px.size() + hand.missing_px.size();
}

/// Keeps the share of the values that leaves kPointsPerHand of `all`.
static void thin(std::vector<float>& values, std::size_t all) {
  if (all <= kPointsPerHand) return;
  const std::size_t kept = values.size() * kPointsPerHand / all;
  for (std::size_t i = 0; i < kept; ++i) values[i] = values[i * values.size() / kept];
  values.resize(kept);
}

void LiveScore::add(twin::FrameScore score, int foldovers) {
  for (auto& hand : score.hands) {
    const std::size_t all = points(hand);
    for (auto* values : {&hand.interior_px, &hand.interior_mm, &hand.missing_px})
      thin(*values, all);
  }
  if (frames_ == 0) turn_ns_ = score.display_ns;
  if (score.display_ns - turn_ns_ >= window_ns_) {
    older_ = std::exchange(newer_, {});
    turn_ns_ = score.display_ns;
  }
  for (twin::Metrics* window : {&older_, &newer_}) {
    window->add(score);
    window->add_foldovers(foldovers);
  }
  ++frames_;
}

nlohmann::json LiveScore::to_json() const { return older_.to_json(); }

}  // namespace handcast::observer
