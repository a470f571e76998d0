// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/pose_history.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/clock.hpp"
#include "renderer/base/joint_math.hpp"
#include "renderer/base/noise.hpp"
#include "renderer/predict/joint_steps.hpp"

namespace handcast::renderer {
namespace {

using msg::Joint;

/// Two samples closer than this give a velocity that is mostly noise.
constexpr std::int64_t kShortestBase_ns = 6'000'000;
/// Two samples this far apart give a velocity with less noise, and an older one.
constexpr std::int64_t kLongBase_ns = 30'000'000;
/// Window over which the speed and the mean of a joint are taken.
constexpr std::int64_t kStillWindow_ns = 50'000'000;

msg::HandPose between(const msg::HandPose& before, const msg::HandPose& after, float t) {
  msg::HandPose pose = after;
  for (int j = 0; j < msg::kJoints; ++j) {
    const Joint &a = before.joints[j], &b = after.joints[j];
    place(pose.joints[j], glm::mix(position(a), position(b), t),
          blend(orientation(a), orientation(b), t));
  }
  return pose;
}

bool is_finite(const msg::HandPose& pose) {
  return std::all_of(pose.joints.begin(), pose.joints.end(), [](const Joint& joint) {
    float sum = 0;
    for (const float x : joint.position_m) sum += x;
    for (const float x : joint.orientation_xyzw) sum += x;
    return std::isfinite(sum);
  });
}

// Accelerations caused by tracker noise.
constexpr float kHandNoise_m_s2 = 10;   ///< of the palm, the mean of its joints
constexpr float kJointNoise_m_s2 = 40;  ///< of one joint relative to that mean
/// The acceleration displaces a joint by at most this much.
constexpr float kMostAccelerated_m = 0.02f;

glm::vec3 beyond_noise(const glm::vec3& acceleration, float noise) {
  return acceleration * share_beyond_noise(glm::dot(acceleration, acceleration), noise);
}

/// Accelerations of the joints beyond noise, from three samples, oldest first, `first_s` and
/// `second_s` apart.
std::array<glm::vec3, msg::kJoints> accelerations(const msg::HandPose& a, const msg::HandPose& b,
                                                  const msg::HandPose& c, float first_s,
                                                  float second_s) {
  std::array<glm::vec3, msg::kJoints> result;
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::vec3 before = (position(b.joints[j]) - position(a.joints[j])) / first_s;
    const glm::vec3 after = (position(c.joints[j]) - position(b.joints[j])) / second_s;
    result[j] = (after - before) * (2 / (first_s + second_s));
  }
  glm::vec3 palm{0};
  for (const int j : kPalmJoints) palm += result[j] / static_cast<float>(kPalmJoints.size());
  const glm::vec3 believed = beyond_noise(palm, kHandNoise_m_s2);
  for (glm::vec3& joint : result) joint = believed + beyond_noise(joint - palm, kJointNoise_m_s2);
  return result;
}

}  // namespace

PoseHistory::PoseHistory(const config::Predict& settings, std::int64_t span_ns)
    : settings_(settings), span_ns_(span_ns) {}

PoseHistory::Pushed PoseHistory::push(std::int64_t origin_ns, const msg::HandPose& pose) {
  if (!is_finite(pose) || origin_ns < begins_ns_) return Pushed::not_measured;
  if (!samples_.empty() && origin_ns > newest_ns()) {
    if (Continuity::frozen(earlier_than(samples_.back(), kShortestBase_ns), samples_.back(), pose))
      return Pushed::not_measured;
    if (breaks({origin_ns, pose})) return Pushed::begins_anew;
  }
  const auto after = std::upper_bound(
      samples_.begin(), samples_.end(), origin_ns,
      [](std::int64_t time_ns, const Sample& sample) { return time_ns < sample.origin_ns; });
  if (after != samples_.begin() && std::prev(after)->origin_ns == origin_ns) {
    std::prev(after)->pose = pose;
  } else {
    samples_.insert(after, Sample{origin_ns, pose});
    since_jump_ = std::min(since_jump_ + 1, kSettled);
  }
  while (samples_.front().origin_ns < newest_ns() - span_ns_) samples_.pop_front();
  judge_stillness();
  return Pushed::goes_on;
}

bool PoseHistory::breaks(const Sample& sample) {
  if (!continuity_.broken(earlier_than(samples_.back(), kShortestBase_ns), samples_.back(), sample))
    return false;
  samples_.clear();
  samples_.push_back(sample);
  begins_ns_ = sample.origin_ns;
  since_jump_ = 1;
  judge_stillness();
  return true;
}

PoseHistory::Stillness PoseHistory::stillness(int joint) const {
  const Sample& newest = samples_.back();
  const glm::vec3 here = position(newest.pose.joints[joint]);
  const glm::quat turn = orientation(newest.pose.joints[joint]);
  glm::vec3 sum{0};
  glm::quat turn_sum{0, 0, 0, 0};
  float furthest_m = 0;
  int count = 0;
  for (auto sample = samples_.rbegin();
       sample != samples_.rend() && newest.origin_ns - sample->origin_ns <= kStillWindow_ns;
       ++sample) {
    const glm::vec3 there = position(sample->pose.joints[joint]);
    const glm::quat then = orientation(sample->pose.joints[joint]);
    furthest_m = std::max(
        {furthest_m, glm::distance(here, there), kTurnLever_m * angle_between(turn, then)});
    sum += there;
    turn_sum = turn_sum + on_side_of(turn, then);
    ++count;
  }
  const auto window_s = static_cast<float>(ns_to_seconds(kStillWindow_ns));
  return {furthest_m / window_s, sum / static_cast<float>(count), glm::normalize(turn_sum)};
}

void PoseHistory::judge_stillness() {
  for (int j = 0; j < msg::kJoints; ++j) stillness_[j] = stillness(j);
}

std::int64_t PoseHistory::newest_ns() const {
  return samples_.empty() ? 0 : samples_.back().origin_ns;
}

std::optional<msg::HandPose> PoseHistory::at(std::int64_t time_ns, std::int64_t lost_ns) const {
  if (samples_.empty() || time_ns - newest_ns() > lost_ns) return std::nullopt;
  if (time_ns <= samples_.front().origin_ns) return samples_.front().pose;
  if (time_ns > newest_ns()) return predicted(time_ns);

  const auto after = std::lower_bound(
      samples_.begin(), samples_.end(), time_ns,
      [](const Sample& sample, std::int64_t wanted_ns) { return sample.origin_ns < wanted_ns; });
  const auto before = std::prev(after);
  const double t = static_cast<double>(time_ns - before->origin_ns) /
                   static_cast<double>(after->origin_ns - before->origin_ns);
  return between(before->pose, after->pose, static_cast<float>(t));
}

const PoseHistory::Sample* PoseHistory::earlier_than(const Sample& sample,
                                                     std::int64_t by_ns) const {
  for (auto earlier = samples_.rbegin(); earlier != samples_.rend(); ++earlier)
    if (sample.origin_ns - earlier->origin_ns >= by_ns) return &*earlier;
  return nullptr;
}

/// Displacements by the acceleration `ahead_ns` (h) after the newest sample. The velocity of two
/// samples is that of the middle between them, dt/2 before the newest one, so a constant
/// acceleration a adds a h (h + dt) / 2.
std::array<glm::vec3, msg::kJoints> PoseHistory::accelerated_m(const Sample& newest,
                                                               const Sample& base,
                                                               std::int64_t ahead_ns) const {
  std::array<glm::vec3, msg::kJoints> moved_m{};
  const Sample* first = settings_.method == config::PredictMethod::acceleration
                            ? earlier_than(base, kShortestBase_ns)
                            : nullptr;
  if (!first) return moved_m;
  const auto first_s = static_cast<float>(ns_to_seconds(base.origin_ns - first->origin_ns));
  const auto second_s = static_cast<float>(ns_to_seconds(newest.origin_ns - base.origin_ns));
  const auto ahead_s = static_cast<float>(ns_to_seconds(ahead_ns));
  moved_m = accelerations(first->pose, base.pose, newest.pose, first_s, second_s);
  for (glm::vec3& joint_m : moved_m) {
    joint_m *= 0.5f * ahead_s * (ahead_s + second_s);
    joint_m *= std::min(1.0f, kMostAccelerated_m / std::max(glm::length(joint_m), 1e-9f));
  }
  return moved_m;
}

msg::HandPose PoseHistory::predicted(std::int64_t time_ns) const {
  const Sample& newest = samples_.back();
  if (settings_.method == config::PredictMethod::hold) return newest.pose;
  const Sample* base = earlier_than(newest, kShortestBase_ns);
  if (!base) return newest.pose;

  const std::int64_t ahead_ns = std::min(time_ns - newest.origin_ns, ms_to_ns(settings_.limit_ms));
  const Sample* long_base = settings_.method == config::PredictMethod::acceleration
                                ? earlier_than(newest, kLongBase_ns)
                                : nullptr;
  const auto since = [&](const Sample& sample) {
    return PoseBefore{sample.pose,
                      static_cast<float>(ns_to_seconds(newest.origin_ns - sample.origin_ns))};
  };
  const auto steps = steps_ahead(newest.pose, since(*base), since(long_base ? *long_base : *base),
                                 static_cast<float>(ns_to_seconds(ahead_ns)));
  const auto still_m_s = static_cast<float>(settings_.still_mm_s * 1e-3);
  const auto by_acceleration_m = accelerated_m(newest, *base, ahead_ns);
  msg::HandPose pose = newest.pose;
  for (int j = 0; j < msg::kJoints; ++j) {
    const JointStep& step = steps[j];
    const Stillness& recent = stillness_[j];
    const float moving =
        still_m_s > 0 ? glm::smoothstep(still_m_s, 2 * still_m_s, recent.speed_m_s) : 1.0f;
    const glm::vec3 moved =
        position(newest.pose.joints[j]) + step.moved_m + step.belief * by_acceleration_m[j];
    place(pose.joints[j], glm::mix(recent.mean_m, moved, moving),
          blend(recent.mean_turn, step.turned, moving));
  }
  return pose;
}

}  // namespace handcast::renderer
