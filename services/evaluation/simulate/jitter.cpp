// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/simulate/jitter.hpp"

#include <algorithm>

namespace handcast::simulate {

void JitterMeter::add(const renderer::FrameHand& hand,
                      const std::array<glm::vec2, msg::kLandmarks>& truth, std::int64_t tick,
                      twin::Metrics& metrics) {
  auto& trail = trails_[static_cast<std::size_t>(hand.side)];
  if (tick != trail.last_tick + 1) trail.length = 0;
  trail.last_tick = tick;

  std::array<glm::vec2, msg::kLandmarks> error;
  double square = 0;
  for (std::size_t i = 0; i < error.size(); ++i) {
    error[i] = hand.corrected[i] - truth[i];
    const auto bend = error[i] - 2.0f * trail.error[1][i] + trail.error[0][i];
    square += glm::dot(bend, bend);
  }
  if (trail.length == 2) metrics.add_jitter(square, msg::kLandmarks);
  trail.length = std::min(trail.length + 1, 2);
  trail.error[0] = trail.error[1];
  trail.error[1] = error;
}

}  // namespace handcast::simulate
