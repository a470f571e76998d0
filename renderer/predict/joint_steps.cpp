// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/joint_steps.hpp"

#include <algorithm>
#include <array>

#include "renderer/base/joint_math.hpp"
#include "renderer/base/noise.hpp"

namespace handcast::renderer {
namespace {

/// Differences of the two velocities that are noise.
constexpr float kHandNoise_m_s = 0.02f;   ///< of the palm, the mean of its joints
constexpr float kJointNoise_m_s = 0.06f;  ///< of one joint relative to it, or at kTurnLever_m
/// A finger whose two velocities differ by more than the first is doubted, by more than the second
/// not believed: with samples that are 9 and 36 ms old, accelerations of 50 and 110 m/s^2.
constexpr float kDoubted_m_s = 0.7f, kImpossible_m_s = 1.5f;

/// The velocities of one joint.
struct Motion {
  glm::vec3 smooth_m_s{0};            ///< since the older sample
  glm::vec3 change_m_s{0};            ///< from it to the one since the recent sample
  glm::quat smooth_turn{1, 0, 0, 0};  ///< the orientation ahead by each of them
  glm::quat recent_turn{1, 0, 0, 0};
};

Motion motion_of(int joint, const msg::HandPose& newest, const PoseBefore& recent,
                 const PoseBefore& older, float ahead_s) {
  const msg::Joint& now = newest.joints[joint];
  const auto m_s = [&](const PoseBefore& before) {
    return (position(now) - position(before.pose.joints[joint])) / before.since_s;
  };
  const auto turn = [&](const PoseBefore& before) {
    return turned_on(orientation(before.pose.joints[joint]), orientation(now),
                     ahead_s / before.since_s);
  };
  return {m_s(older), m_s(recent) - m_s(older), turn(older), turn(recent)};
}

}  // namespace

std::array<JointStep, msg::kJoints> steps_ahead(const msg::HandPose& newest,
                                                const PoseBefore& recent, const PoseBefore& older,
                                                float ahead_s) {
  std::array<Motion, msg::kJoints> motions;
  for (int j = 0; j < msg::kJoints; ++j) motions[j] = motion_of(j, newest, recent, older, ahead_s);
  glm::vec3 palm_m_s{0}, palm_change_m_s{0};
  for (const int j : kPalmJoints) {
    palm_m_s += motions[j].smooth_m_s / static_cast<float>(kPalmJoints.size());
    palm_change_m_s += motions[j].change_m_s / static_cast<float>(kPalmJoints.size());
  }
  const glm::vec3 believed_change_m_s =
      palm_change_m_s *
      share_beyond_noise(glm::dot(palm_change_m_s, palm_change_m_s), kHandNoise_m_s);
  std::array<JointStep, msg::kJoints> steps;
  for (int j = 0; j < msg::kJoints; ++j) {
    const Motion& motion = motions[j];
    const glm::vec3 own_m_s = motion.change_m_s - palm_change_m_s;
    const float turn_m_s = kTurnLever_m * angle_between(motion.smooth_turn, motion.recent_turn) /
                           std::max(ahead_s, 1e-6f);
    const glm::vec3 m_s = motion.smooth_m_s + believed_change_m_s +
                          own_m_s * share_beyond_noise(glm::dot(own_m_s, own_m_s), kJointNoise_m_s);
    JointStep& step = steps[j];
    step.belief = 1 - glm::smoothstep(kDoubted_m_s, kImpossible_m_s,
                                      std::max(glm::length(own_m_s), turn_m_s));
    step.moved_m = ahead_s * glm::mix(palm_m_s + believed_change_m_s, m_s, step.belief);
    step.turned = blend(orientation(newest.joints[j]),
                        blend(motion.smooth_turn, motion.recent_turn,
                              share_beyond_noise(turn_m_s * turn_m_s, kJointNoise_m_s)),
                        step.belief);
  }
  return steps;
}

}  // namespace handcast::renderer
