// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/finger_steps.hpp"

namespace handcast::renderer {
namespace {

constexpr int kJointsOfFinger = 4;
constexpr std::int64_t kPatience_ns = 500'000'000;
constexpr float kStep_px = 8;
constexpr float kSigmas = 2;  ///< a step must also exceed this many sigmas of the detector
/// Shares of the step: what the landmarks' own motion may leave of it, and how much nearer to the
/// common offset it must lead.
constexpr float kExplained = 0.5f, kNearer = 0.7f;

/// The distance that the landmarks of a finger have in common from the expected ones. Empty if
/// there is none to compare.
std::optional<float> distance_px(const msg::HandLandmarks& seen, const ExpectedPoints& expected,
                                 int finger) {
  glm::vec2 sum(0);
  int count = 0;
  for (int i = 1 + kJointsOfFinger * finger; count < kJointsOfFinger; ++i, ++count) {
    if (!was_seen(seen.points[i]) || !expected.known[i]) return std::nullopt;
    sum += position_px(seen.points[i]) - expected.px[i];
  }
  return glm::length(sum) / kJointsOfFinger;
}

/// The distance between two expectations of a finger.
float apart_px(const ExpectedPoints& a, const ExpectedPoints& b, int finger) {
  glm::vec2 sum(0);
  for (int k = 0; k < kJointsOfFinger; ++k) {
    const int i = 1 + kJointsOfFinger * finger + k;
    sum += a.px[i] - b.px[i];
  }
  return glm::length(sum) / kJointsOfFinger;
}

float sigma_px(const msg::HandLandmarks& seen, int finger) {
  float sum = 0;
  for (int k = 0; k < kJointsOfFinger; ++k)
    sum += seen.points[1 + kJointsOfFinger * finger + k].sigma_px;
  return sum / kJointsOfFinger;
}

}  // namespace

FingerSteps::Verdicts FingerSteps::judge(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                                         const ExpectedPoints& expected,
                                         const ExpectedPoints& common,
                                         const ExpectedPoints& alone) {
  Verdicts verdicts{};
  for (int finger = 0; finger < 5; ++finger) {
    auto& held_since_ns = held_since_ns_[finger];
    auto& verdict = verdicts[finger];
    const auto step_px = distance_px(seen, expected, finger),
               common_px = distance_px(seen, common, finger),
               alone_px = distance_px(seen, alone, finger);
    if (!step_px || !common_px || *step_px < kStep_px + kSigmas * sigma_px(seen, finger)) {
      held_since_ns.reset();
      continue;
    }
    const bool is_nearer = *common_px < kNearer * apart_px(expected, common, finger);
    const bool is_trackers = !held_since_ns && alone_px && *alone_px < kExplained * *step_px;
    if (is_nearer) {
      verdict = Verdict::anew;
    } else if (!is_trackers) {
      if (!held_since_ns) held_since_ns = origin_ns;
      verdict = origin_ns - *held_since_ns < kPatience_ns ? Verdict::hold : Verdict::anew;
    }
    if (verdict == Verdict::anew) held_since_ns.reset();
  }
  return verdicts;
}

}  // namespace handcast::renderer
