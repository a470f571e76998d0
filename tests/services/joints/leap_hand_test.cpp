// SPDX-License-Identifier: Apache-2.0
// From Leap's joints and bones to those of the rig.
#include "services/joints/leap_hand.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "services/joints/conventions.hpp"

namespace handcast::joints {
namespace {

using glm::dvec3;

void expect_near(const dvec3& a, const dvec3& b) { EXPECT_LT(glm::distance(a, b), 1e-12); }

TEST(AxesOfBone, TheTipIsAlongMinusZAndTheBackAlongY) {
  const auto axes = axes_of_bone({0, 10, 0}, {0, 3, -7});
  ASSERT_TRUE(axes);
  expect_near(*axes * dvec3(0, 0, -1), {0, 1, 0});
  expect_near(*axes * dvec3(0, 1, 0), {0, 0, 1});
  expect_near(*axes * dvec3(1, 0, 0), glm::cross(dvec3(0, 0, 1), dvec3(0, -1, 0)));
}

TEST(AxesOfBone, WhatIsNoPairOfDirectionsHasNoAxes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(axes_of_bone({0, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(axes_of_bone({0, 2, 0}, {0, 1, 0}));
  EXPECT_FALSE(axes_of_bone({0, nan, 0}, {0, 1, 0}));
}

TEST(RigHand, EachJointIsTakenFromTheBoneThatStartsThere) {
  LeapHand hand{.side = msg::Side::right, .confidence = 0.25f};
  for (int j = 0; j < kLeapJoints; ++j) hand.joint_mm[j] = {1000.0 * j, 0, 0};
  for (int b = 0; b < kLeapBones; ++b) hand.axes[b] = glm::angleAxis(0.1 * b, dvec3(0, 1, 0));
  const auto pose = rig_hand(hand);
  EXPECT_EQ(pose.side, msg::Side::right);
  EXPECT_EQ(pose.confidence, 0.25f);
  const auto is_joint = [&](int joint, float leap_joint, int bone) {
    EXPECT_FLOAT_EQ(pose.joints[joint].position_m[0], leap_joint) << joint;
    EXPECT_NEAR(pose.joints[joint].orientation_xyzw[1], std::sin(0.05 * bone), 1e-6) << joint;
  };
  is_joint(1, 1, 0);     // wrist, with the axes of the palm
  is_joint(2, 3, 3);     // thumb: its first bone has no length
  is_joint(5, 9, 5);     // its tip, with the axes of the distal bone
  is_joint(6, 10, 6);    // index finger: metacarpal
  is_joint(7, 11, 7);    // its knuckle
  is_joint(25, 41, 21);  // tip of the little finger
}

TEST(RigHand, ThePalmIsInTheMiddleOfTheMetacarpalOfTheMiddleFinger) {
  LeapHand hand;
  hand.joint_mm[18] = {2, 10, 0};
  hand.joint_mm[19] = {4, 30, 0};
  const auto palm = rig_hand(hand).joints[kPalm].position_m;
  EXPECT_FLOAT_EQ(palm[0], 0.003f);
  EXPECT_FLOAT_EQ(palm[1], 0.020f);
}

TEST(RigHand, AJointHasHalfTheMeanWidthOfItsBones) {
  LeapHand hand;
  hand.width_mm[7] = 20;  // proximal bone of the index finger
  hand.width_mm[8] = 16;
  hand.width_mm[9] = 12;
  const auto pose = rig_hand(hand);
  EXPECT_FLOAT_EQ(pose.joints[8].radius_m, 0.009f) << "between two bones";
  EXPECT_FLOAT_EQ(pose.joints[10].radius_m, 0.006f) << "the tip has only one";
  EXPECT_FLOAT_EQ(pose.joints[11].radius_m, 0) << "unknown";
}

TEST(Conventions, ASourceThatSaysNothingIsToldAsSuch) {
  EXPECT_THAT(sentence_of({}), testing::HasSubstr("does not say where its joints lie"));
  EXPECT_THAT(sentence_of(kLeap), testing::AllOf(testing::HasSubstr("ends of the bones"),
                                                 testing::HasSubstr("the palm is half-way")));
}

}  // namespace
}  // namespace handcast::joints
