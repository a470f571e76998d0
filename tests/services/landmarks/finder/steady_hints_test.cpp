// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/finder/steady_hints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace handcast::landmarks {
namespace {

using msg::Side;

constexpr std::int64_t kImage_ns = 5'000'000;
constexpr int kTip = 12;

Points open_hand() {
  Points points;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {300 + 20 * static_cast<float>((i + 3) / 4), 300 - 40 * static_cast<float>(i % 4)};
  return points;
}

Points with_tip_moved(Points points, float by_px) {
  points[kTip].x += by_px;
  return points;
}

void remember(SteadyHints& hints, int image, const Points& found, const Points& hint) {
  FoundHand hand;
  hand.side = Side::left;
  hand.points_px = found;
  hints.remember(std::vector{hand}, {hint, std::nullopt}, image * kImage_ns);
}

/// The tracker's tip was 6 px off for a second, and then `step_px` more.
SteadyHints after_a_step(float step_px) {
  SteadyHints hints;
  int image = 0;
  for (; image < 200; ++image) remember(hints, image, open_hand(), with_tip_moved(open_hand(), 6));
  remember(hints, image, open_hand(), with_tip_moved(open_hand(), 6 + step_px));
  return hints;
}

TEST(SteadyHints, WithoutAnImageAHintStays) {
  EXPECT_EQ(SteadyHints().steadied(Side::left, open_hand()), open_hand());
}

TEST(SteadyHints, AJointThatStepsOverARestingHandIsPutBack) {
  const Points hint = with_tip_moved(open_hand(), 16);
  const Points steady = after_a_step(10).steadied(Side::left, hint);
  EXPECT_NEAR(steady[kTip].x, hint[kTip].x - 10, 0.2f);
  EXPECT_EQ(steady[0], hint[0]);
  EXPECT_EQ(after_a_step(10).steadied(Side::right, hint), hint);
}

TEST(SteadyHints, ALastingErrorOfTheTrackerStays) {
  const Points hint = with_tip_moved(open_hand(), 6);
  EXPECT_NEAR(after_a_step(0).steadied(Side::left, hint)[kTip].x, hint[kTip].x, 1e-3f);
}

TEST(SteadyHints, ATrackerThatLeavesTheHandIsFollowed) {
  const Points hint = with_tip_moved(open_hand(), 86);
  EXPECT_EQ(after_a_step(80).steadied(Side::left, hint), hint);
}

TEST(SteadyHints, AHandThatIsNotFoundIsForgotten) {
  SteadyHints hints = after_a_step(10);
  hints.remember({}, {open_hand(), std::nullopt}, 202 * kImage_ns);
  EXPECT_EQ(hints.steadied(Side::left, open_hand()), open_hand());
}

}  // namespace
}  // namespace handcast::landmarks
