// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/pipeline/pipeline.hpp"
#include "services/evaluation/twin/metrics.hpp"
#include "services/evaluation/twin/twin.hpp"

namespace handcast::simulate {

/// Trembling of the corrected landmarks against the true ones: RMS of the second difference of
/// their error over successive projector frames, camera px. On a motion at rest this is the
/// still-hand jitter of METHOD section 5.
class JitterMeter {
 public:
  void add(const renderer::FrameHand& hand, const std::array<glm::vec2, msg::kLandmarks>& truth,
           std::int64_t tick, twin::Metrics& metrics);

 private:
  struct Trail {
    std::int64_t last_tick = -10;
    int length = 0;  ///< successive frames held, up to two
    std::array<std::array<glm::vec2, msg::kLandmarks>, 2> error{};
  };
  std::array<Trail, msg::kMaxHands> trails_;
};

}  // namespace handcast::simulate
