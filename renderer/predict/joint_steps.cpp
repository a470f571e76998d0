// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/joint_steps.hpp"

#include <algorithm>

#include "renderer/base/noise.hpp"
#include "renderer/predict/joint_math.hpp"

namespace handcast::renderer {
namespace {

constexpr int kPalm = 0;  ///< joint
/// A difference of the two velocities that is noise.
constexpr float kNoise_m_s = 0.1f;
/// From the first difference of a finger's two velocities on it is doubted, from the second on not
/// believed: with samples 9 and 30 ms old, accelerations of 60 and 130 m/s^2; a tapping finger has
/// 20.
constexpr float kDoubted_m_s = 0.7f, kImpossible_m_s = 1.5f;

/// The motion of one joint by the velocity since an earlier sample.
struct Velocity {
  glm::vec3 m_s{0};
  glm::quat turned{1, 0, 0, 0};
};

Velocity velocity(const msg::HandPose& newest, const PoseBefore& before, int joint, float ahead_s) {
  const msg::Joint &now = newest.joints[joint], &then = before.pose.joints[joint];
  return {(position(now) - position(then)) / before.since_s,
          turned_on(orientation(then), orientation(now), ahead_s / before.since_s)};
}

float share_of_recent(float difference_m_s) {
  return share_beyond_noise(difference_m_s * difference_m_s, kNoise_m_s);
}

}  // namespace

std::array<JointStep, msg::kJoints> steps_ahead(const msg::HandPose& newest,
                                                const PoseBefore& recent, const PoseBefore& older,
                                                float ahead_s) {
  std::array<JointStep, msg::kJoints> steps;
  glm::vec3 palm_m_s{0}, palm_change_m_s{0};
  for (int j = 0; j < msg::kJoints; ++j) {
    const Velocity fresh = velocity(newest, recent, j, ahead_s),
                   smooth = velocity(newest, older, j, ahead_s);
    const glm::vec3 change_m_s = fresh.m_s - smooth.m_s;
    const float turn_m_s =
        kTurnLever_m * angle_between(fresh.turned, smooth.turned) / std::max(ahead_s, 1e-6f);
    const glm::vec3 m_s = glm::mix(smooth.m_s, fresh.m_s, share_of_recent(glm::length(change_m_s)));
    if (j == kPalm) palm_m_s = m_s, palm_change_m_s = change_m_s;
    const float beyond_palm_m_s = std::max(glm::distance(change_m_s, palm_change_m_s), turn_m_s);
    JointStep& step = steps[j];
    step.belief =
        j == kPalm ? 1 : 1 - glm::smoothstep(kDoubted_m_s, kImpossible_m_s, beyond_palm_m_s);
    step.moved_m = ahead_s * glm::mix(palm_m_s, m_s, step.belief);
    step.turned = blend(orientation(newest.joints[j]),
                        blend(smooth.turned, fresh.turned, share_of_recent(turn_m_s)), step.belief);
  }
  return steps;
}

}  // namespace handcast::renderer
