// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/finger_faults.hpp"

#include <algorithm>

namespace handcast::renderer {

glm::vec2 median_of(std::span<glm::vec2> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  glm::vec2 median;
  for (int axis = 0; axis < 2; ++axis) {
    std::nth_element(values.begin(), middle, values.end(),
                     [axis](glm::vec2 a, glm::vec2 b) { return a[axis] < b[axis]; });
    median[axis] = (*middle)[axis];
  }
  return median;
}

float common_error_px(const msg::HandLandmarks& seen, const ExpectedPoints& expected) {
  std::array<glm::vec2, kLandmarks> errors_px;
  std::size_t count = 0;
  for (int i = 0; i < kLandmarks; ++i)
    if (was_seen(seen.points[i]) && expected.known[i])
      errors_px[count++] = position_px(seen.points[i]) - expected.px[i];
  return count > 0 ? glm::length(median_of(std::span(errors_px).first(count))) : 0;
}

namespace {

constexpr std::int64_t kOrderPatience_ns = 500'000'000;
/// Fingers closer to their expected places than this are left as they are.
constexpr float kFarFromOrder_px = 15;
/// Fingers are exchanged if this share of the distance remains with the fingers exchanged.
constexpr float kCloser = 0.3f;

/// Mean distance of the seen landmarks of `finger` from the expected ones of the finger `place`.
/// Empty if there is none to compare.
std::optional<float> order_distance_px(const msg::HandLandmarks& seen,
                                       const ExpectedPoints& expected, int finger, int place) {
  float sum = 0;
  int count = 0;
  for (int k = 0; k < kLandmarksOfFinger; ++k) {
    const int from = first_landmark(finger) + k, to = first_landmark(place) + k;
    if (!was_seen(seen.points[from]) || !expected.known[to]) continue;
    sum += glm::distance(position_px(seen.points[from]), expected.px[to]);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<float>(count);
}

/// What an exchange of two fingers leaves of their distance from the expected places, as a share.
/// Empty if they cannot be compared, or one of them is at its place.
std::optional<float> left_by_exchange(const msg::HandLandmarks& seen,
                                      const ExpectedPoints& expected, int a, int b) {
  const auto a_a = order_distance_px(seen, expected, a, a),
             b_b = order_distance_px(seen, expected, b, b);
  const auto a_b = order_distance_px(seen, expected, a, b),
             b_a = order_distance_px(seen, expected, b, a);
  if (!a_a || !b_b || !a_b || !b_a || std::min(*a_a, *b_b) <= kFarFromOrder_px) return std::nullopt;
  return (*a_b + *b_a) / (*a_a + *b_b);
}

}  // namespace

msg::HandLandmarks FingerOrder::mended(std::int64_t origin_ns, const msg::HandLandmarks& seen,
                                       const ExpectedPoints& expected,
                                       const ExpectedPoints& by_tracker) {
  msg::HandLandmarks mended = seen;
  bool wrong = false, trackers_too = true;
  for (int a = 0; a < kFingers; ++a)
    for (int b = a + 1; b < kFingers; ++b) {
      if (left_by_exchange(mended, expected, a, b).value_or(1) >= kCloser) continue;
      trackers_too = trackers_too && left_by_exchange(mended, by_tracker, a, b).value_or(1) < 1;
      std::swap_ranges(&mended.points[first_landmark(a)],
                       &mended.points[first_landmark(a)] + kLandmarksOfFinger,
                       &mended.points[first_landmark(b)]);
      wrong = true;
    }
  if (!wrong) {
    wrong_since_ns_.reset();
    return seen;
  }
  if (!wrong_since_ns_) wrong_since_ns_ = origin_ns;
  return trackers_too || origin_ns - *wrong_since_ns_ < kOrderPatience_ns ? mended : seen;
}

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
