// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include "services/lab/hand_maker/hand_shape.hpp"

namespace handcast::renderer {
namespace {

glm::vec3 place_mm(const JointFrames& frames, int joint) {
  return glm::vec3(frames[joint][3]) * 1e3f;
}

TEST(HandShape, TheMeanHandStandsWhereItWasMeasured) {
  const JointFrames rest = rest_frames(HandShape::mean());
  const std::pair<int, glm::vec3> known_mm[] = {
      {0, {6.2f, 4, -57}},          {1, {0, 0, 0}},
      {5, {72.3f, -57.8f, -93.3f}}, {10, {40.9f, -13.8f, -170.3f}},
      {15, {11, -13.3f, -183}},     {20, {-20, -14.6f, -172.6f}},
      {23, {-37, -4.9f, -105.9f}},  {25, {-46, -15.3f, -142.3f}}};
  for (const auto& [joint, expected] : known_mm)
    EXPECT_LT(glm::distance(place_mm(rest, joint), expected), 0.15f) << kJointNames[joint];
}

TEST(HandShape, JointsPointToTheirChildrenAndTheirBacksUp) {
  const JointFrames rest = rest_frames(HandShape::mean());
  for (int j = 0; j < kJoints; ++j) {
    const glm::mat3 axes(rest[j]);
    EXPECT_NEAR(glm::determinant(axes), 1, 1e-4) << kJointNames[j];
    const int parent = kJointParent[j];
    if (j < 3 || parent <= 1) continue;
    const glm::vec3 bone = glm::normalize(glm::vec3(rest[j][3] - rest[parent][3]));
    const bool metacarpal = kJointParent[parent] == 1;
    if (!metacarpal) {
      EXPECT_GT(glm::dot(bone, -glm::vec3(rest[parent][2])), 0.9999f) << kJointNames[j];
    }
    EXPECT_GT(axes[1].y, 0.4f) << kJointNames[j];
  }
}

TEST(HandShape, JointNamesRunFromThePalmToTheLittleFingersTip) {
  EXPECT_EQ(kJointNames[0], "palm");
  EXPECT_EQ(kJointNames[1], "wrist");
  EXPECT_EQ(kJointNames[5], "thumb-tip");
  EXPECT_EQ(kJointNames[6], "index-finger-metacarpal");
  EXPECT_EQ(kJointNames[11], "middle-finger-metacarpal");
  EXPECT_EQ(kJointNames[16], "ring-finger-metacarpal");
  EXPECT_EQ(kJointNames[25], "pinky-finger-tip");
  for (int j = 0; j < kJoints; ++j) EXPECT_EQ(kJointParent[j] < 0, j == 1);
}

TEST(HandShape, ScalingChangesLengthsPalmAndWidthEachByItself) {
  const HandShape mean = HandShape::mean(), person = mean.scaled({1, 1.1f, 1, 1, 1}, 1.2f, 0.9f);
  EXPECT_FLOAT_EQ(person.phalanx_mm[1][0], mean.phalanx_mm[1][0] * 1.1f);
  EXPECT_FLOAT_EQ(person.phalanx_mm[2][0], mean.phalanx_mm[2][0]);
  EXPECT_FLOAT_EQ(person.proximal_mm[2].z, mean.proximal_mm[2].z * 1.2f);
  EXPECT_FLOAT_EQ(person.radius_mm[3][1], mean.radius_mm[3][1] * 0.9f);
  EXPECT_FLOAT_EQ(person.wrist_half_axes_mm.x, mean.wrist_half_axes_mm.x * 0.9f);
  EXPECT_FLOAT_EQ(person.forearm_mm, mean.forearm_mm);
}

TEST(HandShape, RadiiAreInMetresAndShrinkTowardsTheTips) {
  const auto radius_m = joint_radii_m(HandShape::mean());
  EXPECT_FLOAT_EQ(radius_m[2], 0.013f);
  EXPECT_FLOAT_EQ(radius_m[5], 0.0084f);
  EXPECT_FLOAT_EQ(radius_m[7], 0.0104f);
  EXPECT_FLOAT_EQ(radius_m[25], 0.0061f);
  for (int j = 0; j < kJoints; ++j) EXPECT_GT(radius_m[j], 0.005f) << kJointNames[j];
}

TEST(FramesOf, AJointsAxesAreTheColumnsOfItsRotation) {
  msg::HandPose pose;
  const glm::quat quarter = glm::angleAxis(glm::radians(90.0f), glm::vec3(0, 1, 0));
  pose.joints[7].orientation_xyzw = {quarter.x, quarter.y, quarter.z, quarter.w};
  pose.joints[7].position_m = {0.1f, 0.2f, 0.3f};
  const JointFrames frames = frames_of(pose);
  EXPECT_LT(glm::distance(glm::vec3(frames[7][0]), glm::vec3(0, 0, -1)),
            1e-6f);  // right, after a quarter turn to the left
  EXPECT_LT(glm::distance(glm::vec3(frames[7][1]), glm::vec3(0, 1, 0)), 1e-6f);
  EXPECT_LT(glm::distance(-glm::vec3(frames[7][2]), glm::vec3(-1, 0, 0)),
            1e-6f);  // towards the tip
  EXPECT_EQ(glm::vec3(frames[7][3]), glm::vec3(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(frames[3], glm::mat4(1));
}

}  // namespace
}  // namespace handcast::renderer
