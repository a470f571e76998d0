// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/sampler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace handcast::pose::openxr {
namespace {

constexpr float kFarthest_m = 100;
constexpr float kUnit = 0.1f;  ///< how far the length of an orientation may be from 1

bool is_sane(const msg::Joint& joint) {
  float length2 = 0;
  for (const float part : joint.orientation_xyzw) length2 += part * part;
  return std::ranges::all_of(joint.position_m,
                             [](float part) { return std::abs(part) < kFarthest_m; }) &&
         std::abs(std::sqrt(length2) - 1) < kUnit && joint.radius_m >= 0 && joint.radius_m < 1;
}

bool is_there(const Answer& answer) { return answer.is_active && answer.is_whole; }

bool are_equal(const Answer& one, const Answer& other) {
  if (is_there(one) != is_there(other)) return false;
  return !is_there(one) ||
         std::ranges::equal(one.joints, other.joints, [](const auto& a, const auto& b) {
           return a.position_m == b.position_m && a.orientation_xyzw == b.orientation_xyzw;
         });
}

/// A joint that the runtime infers from others counts half.
float confidence_of(const Answer& answer) {
  return 0.5f + 0.5f * static_cast<float>(answer.tracked) / msg::kJoints;
}

}  // namespace

bool Sampler::are_equal(const Answers& answers, const Answers& others) {
  if (std::ranges::none_of(answers, is_there)) return false;
  return openxr::are_equal(answers[0], others[0]) && openxr::are_equal(answers[1], others[1]);
}

Result<bool> Sampler::take(const Answers& answers, msg::HandPoses& poses) {
  const bool is_new = has_last_ && !are_equal(answers, last_);
  last_ = answers;
  has_last_ = true;
  if (!is_new) return false;
  bool is_garbage = false;
  poses.count = 0;
  for (std::size_t side = 0; side < answers.size(); ++side) {
    const auto& answer = answers[side];
    if (!is_there(answer)) continue;
    if (!std::ranges::all_of(answer.joints, is_sane)) {
      is_garbage = true;
      continue;
    }
    poses.hands[poses.count++] = {.side = static_cast<msg::Side>(side),
                                  .confidence = confidence_of(answer),
                                  .joints = answer.joints};
  }
  if (is_garbage && poses.count == 0)
    return fail(Errc::bad_data, "the runtime reports joints that no hand has");
  return true;
}

}  // namespace handcast::pose::openxr
