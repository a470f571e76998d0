// SPDX-License-Identifier: Apache-2.0
#include "services/observer/live_score.hpp"

#include <nlohmann/json.hpp>

namespace handcast::observer {

static constexpr std::size_t kPointsPerHand = 300;

static void thin(std::vector<float>& values) {
  if (values.size() <= kPointsPerHand) return;
  for (std::size_t i = 0; i < kPointsPerHand; ++i)
    values[i] = values[i * values.size() / kPointsPerHand];
  values.resize(kPointsPerHand);
}

void LiveScore::add(twin::FrameScore score, int foldovers) {
  for (auto& hand : score.hands) {
    thin(hand.interior_px);
    thin(hand.interior_mm);
  }
  if (frames_ == 0) turn_ns_ = score.lit_ns;
  if (score.lit_ns - turn_ns_ >= window_ns_) {
    older_ = std::exchange(newer_, {});
    turn_ns_ = score.lit_ns;
  }
  for (twin::Metrics* window : {&older_, &newer_}) {
    window->add(score);
    window->add_foldovers(foldovers);
  }
  ++frames_;
}

nlohmann::json LiveScore::to_json() const { return older_.to_json(); }

}  // namespace handcast::observer
