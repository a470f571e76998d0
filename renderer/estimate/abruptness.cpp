// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/abruptness.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

/// A detector that is shown where the tracker has the joints follows it by a part.
Abrupt more_abrupt(float tracker_px, float detector_px) {
  constexpr float kLeast_px = 5, kFollows = 0.5f;
  if (std::max(tracker_px, detector_px) < kLeast_px) return Abrupt::neither;
  return tracker_px > kFollows * detector_px ? Abrupt::tracker : Abrupt::detector;
}

}  // namespace

AbruptLandmarks Abruptness::add(std::int64_t time_ns, const LandmarkPoints& tracker_px,
                                const LandmarkPoints& detector_px) {
  constexpr std::int64_t kLongest_ns = 100'000'000;
  AbruptLandmarks abrupt;
  abrupt.fill(Abrupt::tracker);
  if (before_ && time_ns - before_->time_ns < kLongest_ns) {
    const float steps =
        static_cast<float>(time_ns - last_->time_ns) /
        static_cast<float>(std::max<std::int64_t>(1, last_->time_ns - before_->time_ns));
    const auto change_px = [&](glm::vec2 now, glm::vec2 last, glm::vec2 before) {
      return glm::length(now - last - steps * (last - before));
    };
    for (int i = 0; i < kLandmarks; ++i)
      abrupt[i] =
          more_abrupt(change_px(tracker_px[i], last_->tracker_px[i], before_->tracker_px[i]),
                      change_px(detector_px[i], last_->detector_px[i], before_->detector_px[i]));
  }
  before_ = last_;
  last_ = Glimpse{time_ns, tracker_px, detector_px};
  return abrupt;
}

}  // namespace handcast::renderer
