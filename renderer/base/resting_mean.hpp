// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

namespace handcast::renderer {

/// The mean of a vector that belongs to a point of the image: over two seconds while the point
/// rests, and over the less time the faster it moves, because the vector is another one elsewhere.
/// One thread, no allocation.
class RestingMean {
 public:
  /// Adds the vector `value` that was found when its point was at `at_px`, and returns the mean. A
  /// time before that of the last call counts as the same time.
  glm::vec2 add(std::int64_t time_ns, glm::vec2 value, glm::vec2 at_px) {
    if (!known_) {
      known_ = true;
      since_ns_ = newest_ns_ = time_ns;
      mean_ = value;
      at_px_ = at_px;
    }
    const float step_s = seconds(time_ns - newest_ns_);
    newest_ns_ = std::max(newest_ns_, time_ns);
    const glm::vec2 moved = (at_px - at_px_) / kMoved_px;
    const float window_s =
        std::min(kResting_s / (1 + glm::dot(moved, moved)), seconds(newest_ns_ - since_ns_));
    const float share = window_s > step_s ? step_s / window_s : 1;
    mean_ += share * (value - mean_);
    at_px_ += share * (at_px - at_px_);
    return mean_;
  }
  /// Drops all vectors.
  void forget() { *this = RestingMean(); }

 private:
  static constexpr float kResting_s = 2;  ///< window of a point at rest
  /// A point this far from its own mean has half the window.
  static constexpr float kMoved_px = 1;

  static float seconds(std::int64_t ns) {
    return 1e-9f * static_cast<float>(std::max<std::int64_t>(ns, 0));
  }

  bool known_ = false;
  std::int64_t since_ns_ = 0, newest_ns_ = 0;
  glm::vec2 mean_{0}, at_px_{0};
};

}  // namespace handcast::renderer
