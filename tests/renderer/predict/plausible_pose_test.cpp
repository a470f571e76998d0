// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/plausible_pose.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace handcast::renderer {
namespace {

constexpr int kWrist = 1, kThumbTip = 5;

/// A hand 0.4 m in front of a camera that stands at the tracker.
msg::HandPose hand() {
  msg::HandPose pose;
  for (int j = 0; j < msg::kJoints; ++j) pose.joints[j].position_m = {0.005f * j, 0, 0.4f};
  return pose;
}

const glm::dmat4 kSame(1);

TEST(PlausiblePose, IsAHandInFrontOfTheCamera) { EXPECT_TRUE(is_plausible(hand(), kSame)); }

TEST(PlausiblePose, IsNotFarAwayOrFarApart) {
  for (const float far : {4.0f, 1e3f, -7.7e36f}) {
    auto all = hand();
    for (auto& joint : all.joints) joint.position_m[1] += far;
    EXPECT_FALSE(is_plausible(all, kSame)) << far;
    auto one = hand();
    one.joints[kThumbTip].position_m[1] = far;
    EXPECT_FALSE(is_plausible(one, kSame)) << far;
  }
}

TEST(PlausiblePose, CountsTheDistanceFromTheCameraAndNotFromTheTracker) {
  glm::dmat4 camera_from_tracker(1);
  camera_from_tracker[3] = {0, 0, -5, 1};
  EXPECT_FALSE(is_plausible(hand(), camera_from_tracker));
  auto pose = hand();
  for (auto& joint : pose.joints) joint.position_m[2] += 5;
  EXPECT_TRUE(is_plausible(pose, camera_from_tracker));
  EXPECT_FALSE(is_plausible(pose, kSame));
}

TEST(PlausiblePose, HasFiniteNumbersAndUnitOrientations) {
  for (const float odd :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    auto place = hand();
    place.joints[kWrist].position_m[0] = odd;
    EXPECT_FALSE(is_plausible(place, kSame));
    auto turn = hand();
    turn.joints[kThumbTip].orientation_xyzw[2] = odd;
    EXPECT_FALSE(is_plausible(turn, kSame));
  }
  auto none = hand();
  none.joints[kThumbTip].orientation_xyzw = {0, 0, 0, 0};
  EXPECT_FALSE(is_plausible(none, kSame));
}

}  // namespace
}  // namespace handcast::renderer
