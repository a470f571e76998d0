// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/finger_steps.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

constexpr std::int64_t kStepPatience_ns = 500'000'000;
constexpr float kStep_px = 8;
constexpr float kSigmas = 2;  ///< a step must also exceed this many sigmas of the detector
/// Shares of the step: what the landmarks' own motion may leave of it, and how much nearer to the
/// common offset it must lead.
constexpr float kExplained = 0.5f, kNearer = 0.7f;

/// The distances of a finger's landmarks in two places, the second smallest of the four: a single
/// landmark is not the finger, and the knuckle of a wrong finger may be right.
float typical_px(std::array<float, kLandmarksOfFinger> distances_px) {
  std::ranges::nth_element(distances_px, distances_px.begin() + 1);
  return distances_px[1];
}

/// How far the landmarks of a finger are from the expected ones. Empty if one cannot be compared.
std::optional<float> step_distance_px(const msg::HandLandmarks& seen,
                                      const ExpectedPoints& expected, int finger) {
  std::array<float, kLandmarksOfFinger> distances_px;
  for (int k = 0; k < kLandmarksOfFinger; ++k) {
    const int i = first_landmark(finger) + k;
    if (!was_seen(seen.points[i]) || !expected.known[i]) return std::nullopt;
    distances_px[k] = glm::distance(position_px(seen.points[i]), expected.px[i]);
  }
  return typical_px(distances_px);
}

float apart_px(const ExpectedPoints& a, const ExpectedPoints& b, int finger) {
  std::array<float, kLandmarksOfFinger> distances_px;
  for (int k = 0; k < kLandmarksOfFinger; ++k) {
    const int i = first_landmark(finger) + k;
    distances_px[k] = glm::distance(a.px[i], b.px[i]);
  }
  return typical_px(distances_px);
}

float sigma_px(const msg::HandLandmarks& seen, int finger) {
  float sum = 0;
  for (int k = 0; k < kLandmarksOfFinger; ++k)
    sum += seen.points[first_landmark(finger) + k].sigma_px;
  return sum / kLandmarksOfFinger;
}

}  // namespace

FingerSteps::Verdicts FingerSteps::judge(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                                         const ExpectedPoints& expected,
                                         const ExpectedPoints& common,
                                         const ExpectedPoints& alone) {
  Verdicts verdicts{};
  for (int finger = 0; finger < kFingers; ++finger) {
    auto& held_since_ns = held_since_ns_[finger];
    auto& verdict = verdicts[finger];
    const auto step_px = step_distance_px(seen, expected, finger),
               common_px = step_distance_px(seen, common, finger),
               alone_px = step_distance_px(seen, alone, finger);
    const bool is_trackers = !held_since_ns && step_px && alone_px && *step_px > kStep_px &&
                             *alone_px < kExplained * *step_px;
    if (is_trackers) {
      verdict = Verdict::anew;
      continue;
    }
    if (!step_px || !common_px || *step_px < kStep_px + kSigmas * sigma_px(seen, finger)) {
      held_since_ns.reset();
      continue;
    }
    const bool is_nearer = *common_px < kNearer * apart_px(expected, common, finger);
    if (is_nearer) {
      verdict = Verdict::anew;
    } else {
      if (!held_since_ns) held_since_ns = origin_ns;
      verdict = origin_ns - *held_since_ns < kStepPatience_ns ? Verdict::hold : Verdict::anew;
    }
    if (verdict == Verdict::anew) held_since_ns.reset();
  }
  return verdicts;
}

}  // namespace handcast::renderer
