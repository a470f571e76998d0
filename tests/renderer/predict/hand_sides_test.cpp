// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/hand_sides.hpp"

#include <gtest/gtest.h>

#include "renderer/predict/hand_track.hpp"
#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::renderer {
namespace {

const glm::vec3 kLeftPlace{-0.12f, 0, 0}, kRightPlace{0.12f, 0, 0};

msg::HandPose called(Side side, msg::HandPose hand) {
  hand.side = side;
  return hand;
}

msg::HandPose left_hand() { return pose_of(Side::left, kLeftPlace); }
msg::HandPose right_hand() { return pose_of(Side::right, kRightPlace); }
HandSides::BySide<msg::HandPose> both() { return {left_hand(), right_hand()}; }

float x_of(const msg::HandPoses& poses, Side side) {
  return poses.find(side)->joints[0].position_m[0];
}

TEST(HandSides, HandsWhereTheyShouldBeKeepTheirNames) {
  HandSides sides;
  const auto named = sides.named(poses_of(0, {left_hand(), right_hand()}), both());
  EXPECT_LT(x_of(named, Side::left), 0);
  EXPECT_GT(x_of(named, Side::right), 0);
}

TEST(HandSides, ExchangedHandsAreExchangedBack) {
  HandSides sides;
  const auto named = sides.named(
      poses_of(0, {called(Side::right, left_hand()), called(Side::left, right_hand())}), both());
  EXPECT_LT(x_of(named, Side::left), 0);
  EXPECT_GT(x_of(named, Side::right), 0);
}

TEST(HandSides, AHandAloneThatIsCalledTheOtherIsKnownByItsPlace) {
  HandSides sides;
  for (const auto& expected :
       {HandSides::BySide<msg::HandPose>{left_hand(), std::nullopt}, both()}) {
    const auto named = sides.named(poses_of(0, {called(Side::right, left_hand())}), expected);
    ASSERT_TRUE(named.find(Side::left));
    EXPECT_FALSE(named.find(Side::right));
  }
}

TEST(HandSides, ANewHandElsewhereIsANewHand) {
  HandSides sides;
  const HandSides::BySide<msg::HandPose> only_left{left_hand(), std::nullopt};
  EXPECT_TRUE(sides.named(poses_of(0, {right_hand()}), only_left).find(Side::right));
  const auto named = sides.named(poses_of(0, {left_hand(), right_hand()}), only_left);
  EXPECT_LT(x_of(named, Side::left), 0);
}

TEST(HandSides, WhereNothingIsKnownTheTrackerIsBelieved) {
  HandSides sides;
  EXPECT_TRUE(sides.named(poses_of(0, {called(Side::right, left_hand())}), {}).find(Side::right));
}

TEST(HandSides, HandsTooCloseToTellApartKeepTheNamesTheyAreGiven) {
  HandSides sides;
  const auto left = pose_of(Side::left, {-0.01f, 0, 0});
  const auto right = called(Side::right, pose_of(Side::left, {0.01f, 0, 0}));
  const auto named = sides.named(
      poses_of(0, {called(Side::right, left), called(Side::left, right)}), {left, right});
  EXPECT_FLOAT_EQ(x_of(named, Side::right), left.joints[0].position_m[0]);
}

TEST(HandSides, ATrackerThatGoesOnSayingSoIsBelieved) {
  HandSides sides;
  const auto swapped = [](std::int64_t ms) {
    return poses_of(ms * kMs, {called(Side::right, left_hand()), called(Side::left, right_hand())});
  };
  EXPECT_LT(x_of(sides.named(swapped(0), both()), Side::left), 0);
  EXPECT_LT(x_of(sides.named(swapped(390), both()), Side::left), 0);
  EXPECT_GT(x_of(sides.named(swapped(410), both()), Side::left), 0);
  // One right message in between.
  sides.named(poses_of(420 * kMs, {left_hand(), right_hand()}), both());
  EXPECT_LT(x_of(sides.named(swapped(430), both()), Side::left), 0);
}

TEST(HandSides, LandmarksThatLieOnTheOtherHandBelongToIt) {
  HandSides sides;
  const auto calibration = rig_above_hand();
  const auto seen = landmarks_of(calibration, 0, left_hand(), {3, 2});
  const HandSides::BySide<LandmarkPoints> places{*project_landmarks(calibration, left_hand()),
                                                 *project_landmarks(calibration, right_hand())};
  EXPECT_TRUE(sides.named(seen, places).find(Side::left));
  auto wrong = seen;
  wrong.hands[0].side = Side::right;
  EXPECT_TRUE(sides.named(wrong, places).find(Side::left));
  EXPECT_FALSE(sides.named(wrong, places).find(Side::right));
}

}  // namespace
}  // namespace handcast::renderer
