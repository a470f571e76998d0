// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/tracker_step.hpp"

#include <gtest/gtest.h>

namespace handcast::calibrate {
namespace {

TEST(TrackerAdvice, AHandThatWasNearlyEverywhereIsToldWhenItEnds) {
  Harvest harvest;
  harvest.goes_on(0.3, true);
  EXPECT_EQ(harvest.advice("Move it."), "Move it.");
  harvest.goes_on(0.6, true);
  EXPECT_EQ(harvest.advice("Move it."), "Enough was seen; it ends in 20 s. Better still: Move it.");
}

TEST(TrackerHands, DamagedOnesAreLeftOut) {
  msg::HandPoses poses;
  EXPECT_TRUE(hands_of(poses).empty());
  poses.count = 1000;
  poses.hands[0].side = static_cast<msg::Side>(7);
  poses.hands[1].side = msg::Side::right;
  const auto hands = hands_of(poses);
  ASSERT_EQ(hands.size(), 1U);
  EXPECT_EQ(hands.front().side, msg::Side::right);
}

}  // namespace
}  // namespace handcast::calibrate
