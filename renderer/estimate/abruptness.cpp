// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/abruptness.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

/// The newest of three images, and the time from the second to it, in those from the first to the
/// second.
struct Latest {
  const HandGlimpse &before, &last, &now;
  double steps;
};

/// How far a landmark is from where its motion led.
float change_px(const LandmarkPoints HandGlimpse::*of, const Latest& latest, int landmark) {
  const glm::vec2 last = (latest.last.*of)[landmark];
  return glm::length((latest.now.*of)[landmark] - last -
                     static_cast<float>(latest.steps) * (last - (latest.before.*of)[landmark]));
}

/// A detector that is shown where the tracker has the joints follows it by a part.
Abrupt more_abrupt(float tracker_px, float detector_px) {
  constexpr float kLeast_px = 5, kFollows = 0.5f;
  if (std::max(tracker_px, detector_px) < kLeast_px) return Abrupt::neither;
  return tracker_px > kFollows * detector_px ? Abrupt::tracker : Abrupt::detector;
}

/// By how much the tracker alone has bent a finger; 0 if it may have moved, or if the detector
/// could not see that.
std::array<double, kBendsOfFinger> snapped_rad(const Latest& latest, int finger) {
  constexpr double kMost_rad_s2 = 2000;             ///< of a finger's joints together
  constexpr float kLeast_px = 12, kFollows = 0.5f;  // of the three upper landmarks together
  std::array<double, kBendsOfFinger> bent_rad;
  double sum_rad = 0;
  for (int b = 0; b < kBendsOfFinger; ++b) {
    const double last_rad = latest.last.flexions_rad[finger][b];
    bent_rad[b] = latest.now.flexions_rad[finger][b] - last_rad -
                  latest.steps * (last_rad - latest.before.flexions_rad[finger][b]);
    sum_rad += bent_rad[b];
  }
  const double step_s = ns_to_seconds(latest.now.time_ns - latest.last.time_ns);
  if (std::abs(sum_rad) < kMost_rad_s2 * step_s * step_s) return {};
  float tracker_px = 0, detector_px = 0;
  for (int i = 1; i < kLandmarksOfFinger; ++i) {
    tracker_px += change_px(&HandGlimpse::tracker_px, latest, first_landmark(finger) + i);
    detector_px += change_px(&HandGlimpse::detector_px, latest, first_landmark(finger) + i);
  }
  if (tracker_px < kLeast_px || detector_px > kFollows * tracker_px) return {};
  return bent_rad;
}

}  // namespace

AbruptChange Abruptness::add(const HandGlimpse& glimpse) {
  constexpr std::int64_t kShort_ns = 100'000'000, kLongest_ns = 400'000'000;
  HandGlimpse now = glimpse;
  for (int finger = 0; finger < kFingers; ++finger)
    for (int b = 0; b < kBendsOfFinger; ++b) now.flexions_rad[finger][b] -= snapped_rad_[finger][b];
  AbruptChange change;
  change.landmarks.fill(Abrupt::tracker);
  const auto span_ns = before_ ? now.time_ns - before_->time_ns : kLongest_ns;
  const auto step_ns = before_ ? std::max<std::int64_t>(1, last_->time_ns - before_->time_ns) : 1;
  const double steps =
      last_ ? static_cast<double>(now.time_ns - last_->time_ns) / static_cast<double>(step_ns) : 0;
  const bool is_regular = span_ns < kLongest_ns && steps > 0.4 && steps < 2.5;  // a slow camera
  if (span_ns < kShort_ns || is_regular) {
    const Latest latest{*before_, *last_, now, steps};
    for (int i = 0; i < kLandmarks; ++i)
      change.landmarks[i] = more_abrupt(change_px(&HandGlimpse::tracker_px, latest, i),
                                        change_px(&HandGlimpse::detector_px, latest, i));
    for (int finger = 0; finger < kFingers; ++finger) {
      change.snapped_rad[finger] = snapped_rad(latest, finger);
      for (int b = 0; b < kBendsOfFinger; ++b) {
        snapped_rad_[finger][b] += change.snapped_rad[finger][b];
        now.flexions_rad[finger][b] -= change.snapped_rad[finger][b];
      }
    }
  }
  before_ = last_;
  last_ = now;
  return change;
}

}  // namespace handcast::renderer
