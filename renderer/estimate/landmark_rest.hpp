// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>

#include "ipc/base/clock.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Whether the landmarks of a hand rest in the image. One thread.
class LandmarkRest {
 public:
  /// Adds the landmarks of an image. Returns 1 if they rest, 0 if they move or half of them are not
  /// seen, between the two if they move slowly: 7 to 20 px/s, RMS.
  float add(std::int64_t time_ns, const msg::HandLandmarks& seen) {
    constexpr double kMean_s = 0.1;
    constexpr float kResting_px = 0.7f, kMoving_px = 2;
    const double passed_s = ns_to_seconds(time_ns - newest_ns_);
    const auto news = static_cast<float>(1 - std::exp(-passed_s / kMean_s));
    newest_ns_ = time_ns;
    float sum_px2 = 0;
    int count = 0;
    for (int i = 0; i < kLandmarks; ++i) {
      if (!was_seen(seen.points[i])) continue;
      const glm::vec2 off_px = position_px(seen.points[i]) - mean_px_[i];
      sum_px2 += glm::dot(off_px, off_px);
      mean_px_[i] += news * off_px;
      ++count;
    }
    if (2 * count <= kLandmarks) return 0;
    return 1 -
           glm::smoothstep(kResting_px, kMoving_px, std::sqrt(sum_px2 / static_cast<float>(count)));
  }

 private:
  LandmarkPoints mean_px_{};
  std::int64_t newest_ns_ = 0;
};

}  // namespace handcast::renderer
