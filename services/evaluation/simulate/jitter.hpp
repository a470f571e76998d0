// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/pipeline/pipeline.hpp"
#include "services/evaluation/twin/metrics.hpp"
#include "services/evaluation/twin/twin.hpp"

namespace handcast::simulate {

/// Jitter of the corrected landmarks: RMS of the second difference of their error over successive
/// projector frames, camera px. The second difference responds to trembling from frame to frame and
/// hardly to slow wobble.
class JitterMeter {
 public:
  /// Adds one hand of projector frame `tick` to `metrics`. `truth`: the true landmarks at its
  /// light.
  void add(const renderer::FrameHand& hand, const std::array<glm::vec2, msg::kLandmarks>& truth,
           std::int64_t tick, twin::Metrics& metrics);

 private:
  struct Trail {
    std::int64_t last_tick = -10;
    int length = 0;  ///< number of successive frames in `error`
    std::array<std::array<glm::vec2, msg::kLandmarks>, 2> error{};
  };
  std::array<Trail, msg::kMaxHands> trails_;
};

}  // namespace handcast::simulate
