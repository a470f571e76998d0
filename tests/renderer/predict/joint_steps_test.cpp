// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/joint_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace handcast::renderer {
namespace {

constexpr int kMiddleTip = 15;
constexpr float kRecent_s = 0.009f, kOlder_s = 0.036f, kAhead_s = 0.018f;

/// All joints at `x_m`, the tip another `tip_m` along x and rotated by `tip_rad` about z.
msg::HandPose hand_at(float x_m, float tip_m = 0, float tip_rad = 0) {
  msg::HandPose pose;
  for (auto& joint : pose.joints) {
    joint.position_m = {x_m, 0, 0};
    joint.orientation_xyzw = {0, 0, 0, 1};
  }
  pose.joints[kMiddleTip].position_m[0] += tip_m;
  pose.joints[kMiddleTip].orientation_xyzw = {0, 0, std::sin(tip_rad / 2), std::cos(tip_rad / 2)};
  return pose;
}

/// The steps after three samples, oldest first.
std::array<JointStep, msg::kJoints> steps(const msg::HandPose& older, const msg::HandPose& recent,
                                          const msg::HandPose& newest) {
  return steps_ahead(newest, {recent, kRecent_s}, {older, kOlder_s}, kAhead_s);
}

float angle_of(const JointStep& step) { return 2 * std::atan2(step.turned.z, step.turned.w); }

TEST(JointSteps, AConstantVelocityGoesOn) {
  const auto ahead =
      steps(hand_at(0), hand_at(0.027f, 0.0027f, 0.27f), hand_at(0.036f, 0.0036f, 0.36f));
  EXPECT_NEAR(ahead[0].moved_m.x, 0.018f, 1e-5f);
  EXPECT_NEAR(ahead[kMiddleTip].moved_m.x, 0.0198f, 1e-5f);
  EXPECT_NEAR(angle_of(ahead[kMiddleTip]), 0.54f, 1e-4f);
}

TEST(JointSteps, NoiseOfTheNewestSampleIsHardlyExtrapolated) {
  const auto ahead = steps(hand_at(0), hand_at(0), hand_at(0, 0.0002f));
  EXPECT_LT(ahead[kMiddleTip].moved_m.x, 0.00013f);  // 0.0004 by the two newest samples alone
}

TEST(JointSteps, AHandThatBrakesIsBelievedAtOnce) {
  const auto ahead = steps(hand_at(0), hand_at(0.036f), hand_at(0.036f));
  EXPECT_NEAR(ahead[kMiddleTip].moved_m.x, 0, 0.0005f);
  EXPECT_EQ(ahead[kMiddleTip].belief, 1);
}

TEST(JointSteps, AFingerThatSnapsGoesWithThePalm) {
  const auto ahead = steps(hand_at(0), hand_at(0.003f), hand_at(0.004f, 0.04f, 0.4f));
  EXPECT_EQ(ahead[kMiddleTip].belief, 0);
  EXPECT_NEAR(ahead[kMiddleTip].moved_m.x, ahead[0].moved_m.x, 1e-6f);
  EXPECT_NEAR(angle_of(ahead[kMiddleTip]), 0.4f, 1e-4f);
  EXPECT_EQ(ahead[kMiddleTip - 1].belief, 1);
}

TEST(JointSteps, AFingerThatTurnsTooFastIsHeld) {
  const auto ahead = steps(hand_at(0), hand_at(0), hand_at(0, 0, 0.5f));
  EXPECT_NEAR(angle_of(ahead[kMiddleTip]), 0.5f, 1e-4f);
}

TEST(JointSteps, AFastTapIsNotASnap) {
  // The newest 9 ms of a tap that accelerates by 30 m/s^2 from rest.
  const auto ahead = steps(hand_at(0), hand_at(0), hand_at(0, 0.0012f));
  EXPECT_EQ(ahead[kMiddleTip].belief, 1);
}

}  // namespace
}  // namespace handcast::renderer
