// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/cover.hpp"

#include <gtest/gtest.h>

#include "tests/services/pose/stereo/two_views.hpp"

namespace handcast::pose::stereo {
namespace {

class CoverTest : public testing::Test {
 protected:
  /// A hand at rest with its back to the first camera.
  PosedHand hand_at(double right_m, double depth_m) const {
    Posture posture;
    posture.palm_m = {right_m, 0};
    posture.turn = glm::angleAxis(-1.57, glm::dvec3(1, 0, 0));
    return skeleton_.posed(posture, depth_m);
  }

  Views views_ = views_of(two_cameras()).value();
  Skeleton skeleton_{renderer::load_hand_or_default({}, msg::Side::left).value()};
};

TEST_F(CoverTest, AHandBehindAnotherIsHiddenAndTheOneInFrontIsNot) {
  const PosedHand front = hand_at(0, 0.65), back = hand_at(0, 0.75);
  EXPECT_GT(hidden_by(front, back, views_[0]).count(), 18u);
  EXPECT_EQ(hidden_by(back, front, views_[0]).count(), 0u);
}

TEST_F(CoverTest, HandsBesideEachOtherHideNothing) {
  EXPECT_EQ(hidden_by(hand_at(0, 0.65), hand_at(0.25, 0.75), views_[0]).count(), 0u);
}

TEST_F(CoverTest, AViewFromTheSideMaySeeWhatTheOtherDoesNot) {
  // The second camera is 0.3 m to the right: what is 0.4 m behind the front hand lies beside it
  // there.
  const PosedHand front = hand_at(0, 0.6), back = hand_at(0, 1);
  EXPECT_GT(hidden_by(front, back, views_[0]).count(), 12u);
  EXPECT_LT(hidden_by(front, back, views_[1]).count(), 5u);
}

}  // namespace
}  // namespace handcast::pose::stereo
