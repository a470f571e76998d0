// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/continuity.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "ipc/base/clock.hpp"
#include "renderer/base/joint_math.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kShortestSilence_ns = 25'000'000;
constexpr std::int64_t kGapWithoutVelocity_ns =
    50'000'000;  ///< no velocity is derived across a longer gap
constexpr double kMostIntervals = 2.5;
constexpr float kSlack_m = 8e-3f;       ///< noise of the samples
constexpr float kLeastLimit_m_s2 = 60;  ///< largest acceleration of a hand that rested
constexpr float kLimitOfUsual = 6;      ///< largest acceleration, in multiples of the usual one
constexpr float kFastest_m_s = 5;       ///< largest speed of a hand whose velocity is unknown
constexpr float kResting_m_s = 20e-3f;
constexpr float kLearning = 0.1f;  ///< share of a new sample in the means
constexpr int kFewestJoints = 4;   ///< the joints of one finger

float seconds_between(const Continuity::Sample& a, const Continuity::Sample& b) {
  return static_cast<float>(ns_to_seconds(b.origin_ns - a.origin_ns));
}

}  // namespace

std::int64_t Continuity::patience_ns() const {
  return std::max(kShortestSilence_ns,
                  static_cast<std::int64_t>(kMostIntervals * static_cast<double>(interval_ns_)));
}

bool Continuity::broken(const Sample* before, const Sample& last, const Sample& next) {
  const std::int64_t step_ns = next.origin_ns - last.origin_ns;
  const bool gap = step_ns > std::max(kGapWithoutVelocity_ns, 2 * patience_ns());
  interval_ns_ += static_cast<std::int64_t>(
      kLearning * static_cast<double>(std::min(step_ns, 4 * interval_ns_) - interval_ns_));
  if (gap) return true;

  const float step_s = seconds_between(last, next),
              before_s = before ? seconds_between(*before, last) : 1;
  // displacement = acceleration * square_s2
  const float square_s2 = 0.5f * step_s * (step_s + before_s);
  const float limit_m =
      kSlack_m + (before ? std::max(kLeastLimit_m_s2, kLimitOfUsual * usual_m_s2_) * square_s2
                         : kFastest_m_s * step_s);
  int beyond = 0;
  float sum_m2 = 0;
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::vec3 here = position(last.pose.joints[j]);
    const glm::vec3 moved =
        before ? (here - position(before->pose.joints[j])) * (step_s / before_s) : glm::vec3(0);
    const glm::vec3 missed = position(next.pose.joints[j]) - here - moved;
    sum_m2 += glm::dot(missed, missed);
    beyond += glm::length(missed) > limit_m;
  }
  if (beyond >= kFewestJoints) return true;
  if (before)
    usual_m_s2_ += kLearning * (std::sqrt(sum_m2 / msg::kJoints) / square_s2 - usual_m_s2_);
  return false;
}

bool Continuity::frozen(const Sample* before, const Sample& last, const msg::HandPose& next) {
  float moved_m = 0;
  for (int j = 0; j < msg::kJoints; ++j) {
    if (next.joints[j].position_m != last.pose.joints[j].position_m) return false;
    if (next.joints[j].orientation_xyzw != last.pose.joints[j].orientation_xyzw) return false;
    if (before)
      moved_m = std::max(
          moved_m, glm::distance(position(last.pose.joints[j]), position(before->pose.joints[j])));
  }
  return before && moved_m > kResting_m_s * seconds_between(*before, last);
}

}  // namespace handcast::renderer
