// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/tracker/joint_convention.hpp"

#include <gtest/gtest.h>

namespace handcast::landmarks {
namespace {

/// A left hand seen from its back, pointing up, its palm 150 px long.
Points hand() {
  Points points{};
  points[0] = {400, 500};
  for (int finger = 0; finger < 5; ++finger)
    for (int k = 0; k < 4; ++k)
      points[1 + 4 * finger + k] = {400.0f - 30.0f * static_cast<float>(finger - 2),
                                    350.0f - 40.0f * static_cast<float>(k)};
  return points;
}

Points mirrored(Points points) {
  for (auto& point : points) point.x = -point.x;
  return points;
}

Points moved(Points points, int i, glm::vec2 by_px) {
  points[i] += by_px;
  return points;
}

/// Shows a hand and its tracker for `seconds`, 100 times a second.
void rest(JointConventionOffsets& offsets, const Points& network_px, const Points& tracker_px,
          double seconds, float step_px = 0) {
  glm::vec2 way(0);
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(seconds * 100); ++i, way.x += step_px) {
    Points network = network_px, tracker = tracker_px;
    for (auto& point : network) point += way;
    for (auto& point : tracker) point += way;
    offsets.learn(i * 10'000'000, network, tracker);
  }
}

TEST(JointConvention, TipsAndTheJointsBelowThemStayWhereTheyWereSeen) {
  JointConventionOffsets offsets;
  rest(offsets, hand(), moved(hand(), 8, {30, 0}), 30);
  const Points moved_px = offsets.to_tracker(hand());
  for (const int i : {3, 4, 6, 7, 8, 10, 11, 12, 14, 15, 16, 18, 19, 20})
    EXPECT_EQ(moved_px[i], hand()[i]) << i;
}

TEST(JointConvention, OneTableServesBothHandsAndBothSides) {
  const JointConventionOffsets offsets;
  const Points seen = offsets.to_tracker(hand()),
               other = mirrored(offsets.to_tracker(mirrored(hand())));
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_NEAR(glm::distance(seen[i], other[i]), 0, 1e-3) << i;
  EXPECT_GT(glm::distance(seen[2], hand()[2]), 10) << "the thumb's knuckle is another one";
}

TEST(JointConvention, AHandThatWasGoneHasNotRested) {
  JointConventionOffsets once, twice;
  const Points other = moved(hand(), 9, {5, 0});
  once.learn(0, hand(), other);
  for (int i = 0; i < 30; ++i) twice.learn(i * 3'000'000'000, hand(), other);
  EXPECT_EQ(once.offsets(), twice.offsets());
}

TEST(JointConvention, AnErrorThatShiftsTurnsOrScalesTheTrackersHandIsNotLearnt) {
  Points wrong = hand();
  for (auto& point : wrong)
    point = glm::vec2(17, -40) +
            1.08f * glm::vec2(0.98f * point.x - 0.2f * point.y, 0.2f * point.x + 0.98f * point.y);
  const auto residual = convention_residual(hand(), wrong);
  ASSERT_TRUE(residual);
  for (const auto& offset : *residual) EXPECT_NEAR(glm::length(offset), 0, 1e-3);
}

TEST(JointConvention, AResidualIsToldInTheHandsOwnFrame) {
  const auto residual = convention_residual(moved(hand(), 0, {0, -15}), hand());
  ASSERT_TRUE(residual);
  EXPECT_NEAR((*residual)[0].x, 15.0f / 135, 1e-3) << "towards the fingers, in palm lengths";
  EXPECT_NEAR((*residual)[0].y, 0, 1e-3);
}

TEST(JointConvention, IsLearntSlowlyAndNeverFar) {
  const Points tracker = moved(hand(), 17, {0, 60});  // 0.4 palm lengths
  const auto learnt = [&](double seconds) {
    JointConventionOffsets offsets;
    const Points before = offsets.offsets();
    rest(offsets, hand(), tracker, seconds);
    return glm::distance(offsets.offsets()[17], before[17]);
  };
  EXPECT_GT(learnt(2), 0.001f);
  EXPECT_LT(learnt(2), 0.02f);
  EXPECT_NEAR(learnt(200), JointConventionOffsets::kReach, 1e-4);
}

TEST(JointConvention, IsNotLearntWhileTheHandMoves) {
  JointConventionOffsets offsets;
  const Points before = offsets.offsets();
  rest(offsets, hand(), moved(hand(), 17, {0, 60}), 10, 1.0f);  // 100 px/s
  EXPECT_EQ(offsets.offsets(), before);
}

TEST(JointConvention, AHandTooSmallToTellIsLeftAlone) {
  Points point{};
  EXPECT_FALSE(convention_residual(point, hand()));
  EXPECT_EQ(JointConventionOffsets().to_tracker(point), point);
}

}  // namespace
}  // namespace handcast::landmarks
