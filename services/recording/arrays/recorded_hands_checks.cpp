// SPDX-License-Identifier: Apache-2.0
#include "services/recording/arrays/recorded_hands_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/statistics.hpp"
#include "services/joints/leap_hand.hpp"

namespace handcast::recording {
namespace {

using joints::kMiddleMetacarpal;
using joints::kWrist;

constexpr double kMostStamp_us = 4e15;  ///< differences in ns fit in 64 bits
constexpr double kShortestStep_us = 100, kLongestStep_us = 1.05e6;

bool is_step_of_a_sensor(double step_us) {
  return step_us >= kShortestStep_us && step_us <= kLongestStep_us;
}

/// "; are they in nanoseconds?": the unit in which the step would be one of a sensor.
std::string guessed_unit(double step) {
  for (const auto& [us, unit] :
       {std::pair{1e-3, "nanoseconds"}, {1e3, "milliseconds"}, {1e6, "seconds"}})
    if (is_step_of_a_sensor(step * us)) return fmt::format("; are they in {}?", unit);
  return {};
}

glm::dvec3 place_of(const msg::HandPose& pose, int joint) {
  const auto& at = pose.joints[static_cast<std::size_t>(joint)].position_m;
  return {at[0], at[1], at[2]};
}

/// From the wrist to the knuckle of the middle finger, which no motion changes.
double palm_length_m(const msg::HandPose& pose) {
  return glm::distance(place_of(pose, kWrist), place_of(pose, kMiddleMetacarpal + 1));
}

/// A palm is 60 to 120 mm long.
std::string fault_of_scale(double length_m) {
  constexpr double kShortest_m = 0.045, kLongest_m = 0.14;
  if (length_m > kShortest_m && length_m < kLongest_m) return {};
  return fmt::format("the palm is {:.3g} mm long; joints must be in millimetres{}", 1000 * length_m,
                     length_m < 1e-3 ? ", are they in metres?" : "");
}

/// What no hand of this palm length can do in one sample.
std::string fault_of_sample(const msg::HandPose& pose, double usual_length_m) {
  constexpr double kFarthestWrist_m = 3, kFarthestJoint_m = 0.8;
  const double length_m = palm_length_m(pose);
  if (!(length_m > usual_length_m / 2 && length_m < usual_length_m * 2))
    return fmt::format("the palm is {:.3g} mm long, in most samples {:.3g} mm", 1000 * length_m,
                       1000 * usual_length_m);
  const auto wrist = place_of(pose, kWrist);
  if (!(glm::length(wrist) < kFarthestWrist_m))
    return fmt::format("the wrist is {:.3g} m away from the tracker; at most {} m are possible",
                       glm::length(wrist), kFarthestWrist_m);
  for (int joint = 0; joint < msg::kJoints; ++joint)
    if (!(glm::distance(place_of(pose, joint), wrist) < kFarthestJoint_m))
      return fmt::format("a joint is {:.3g} m away from the wrist",
                         glm::distance(place_of(pose, joint), wrist));
  return {};
}

/// A hand that was lost for a while may appear anywhere; otherwise 25 m/s is faster than any.
std::string fault_of_jump(const msg::HandPose& before, const msg::HandPose& after,
                          std::int64_t span_ns) {
  constexpr double kJump_m = 0.5, kFastest_m_s = 25;
  const double way_m = glm::distance(place_of(before, kWrist), place_of(after, kWrist));
  if (way_m < kJump_m || way_m < kFastest_m_s * ns_to_seconds(span_ns)) return {};
  return fmt::format("the wrist jumps by {:.3g} m within {:.3g} ms", way_m, ns_to_ms(span_ns));
}

}  // namespace

std::string fault_of_times(std::span<const double> times_us) {
  for (std::size_t i = 0; i < times_us.size(); ++i)
    if (!(std::abs(times_us[i]) < kMostStamp_us))
      return fmt::format("time {} is not a time in microseconds", i);
  if (times_us.size() < 2) return {};
  std::vector<double> steps_us;
  for (std::size_t i = 1; i < times_us.size(); ++i)
    steps_us.push_back(times_us[i] - times_us[i - 1]);
  const double step_us = median(std::move(steps_us));
  if (step_us <= 0 || is_step_of_a_sensor(step_us)) return {};  // 0: the order is checked elsewhere
  return fmt::format(
      "the times are {:.6g} us apart (median), which no sensor is; they must be in "
      "microseconds{}",
      step_us, guessed_unit(step_us));
}

std::string fault_of_poses(std::span<const msg::HandPose> poses,
                           std::span<const std::int64_t> time_ns) {
  std::vector<double> lengths_m;
  for (const auto& pose : poses)
    if (const double length_m = palm_length_m(pose); length_m > 0) lengths_m.push_back(length_m);
  if (lengths_m.empty()) return {};
  const double usual_length_m = median(std::move(lengths_m));
  if (auto fault = fault_of_scale(usual_length_m); !fault.empty()) return fault;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (palm_length_m(poses[i]) == 0) continue;
    auto fault = fault_of_sample(poses[i], usual_length_m);
    if (fault.empty() && i > 0 && palm_length_m(poses[i - 1]) > 0)
      fault = fault_of_jump(poses[i - 1], poses[i], time_ns[i] - time_ns[i - 1]);
    if (!fault.empty()) return fmt::format("sample {}: {}", i, fault);
  }
  return {};
}

}  // namespace handcast::recording
