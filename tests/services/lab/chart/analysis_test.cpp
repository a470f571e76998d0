// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/analysis.hpp"

#include <gmock/gmock.h>

namespace handcast::chart {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

using Points = std::vector<Point>;

TEST(ParetoFront, IsWhatNothingBeatsByAscendingX) {
  const Points points{{8, 4}, {6, 14}, {7, 2}, {6.5, 15}, {6.8, 5}, {9, 1.9}};
  EXPECT_THAT(pareto_front(points), ElementsAre(1u, 4u, 2u, 5u));
}

TEST(ParetoFront, EqualPointsDoNotBeatEachOther) {
  EXPECT_THAT(pareto_front(Points{{1, 1}, {1, 1}}), ElementsAre(0u, 1u));
  EXPECT_THAT(pareto_front(Points{{1, 2}, {1, 1}}), ElementsAre(1u)) << "equal in x, smaller in y";
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(BreakdownPoint, IsWhereTheErrorDoublesBetweenTheStressesThatWereTried) {
  const auto point = breakdown_point(Points{{5, 2}, {10, 3}, {20, 5}, {40, 50}});
  ASSERT_TRUE(point);
  EXPECT_DOUBLE_EQ(point->x, 15);
  EXPECT_DOUBLE_EQ(point->y, 4);
}

TEST(BreakdownPoint, IsTheFirstOfSeveral) {
  EXPECT_DOUBLE_EQ(breakdown_point(Points{{0, 1}, {1, 3}, {2, 1}, {3, 9}})->x, 0.5);
}

TEST(BreakdownPoint, IsNowhereWhereTheErrorNeverDoublesOrThereIsNoneAtFirst) {
  EXPECT_FALSE(breakdown_point(Points{{0, 1}, {1, 1.9}}));
  EXPECT_FALSE(breakdown_point(Points{{0, 0}, {1, 5}}));
  EXPECT_FALSE(breakdown_point(Points{{0, 1}}));
  EXPECT_FALSE(breakdown_point({}));
}

std::vector<double> spread(std::vector<double> marks, double gap, double low, double high) {
  return spread_apart(marks, gap, low, high);
}

TEST(SpreadApart, LeavesAloneWhatHasRoom) {
  EXPECT_THAT(spread({50, 10, 30}, 15, 0, 100), ElementsAre(50, 10, 30));
}

TEST(SpreadApart, MovesWhatTouchesEvenlyAndKeepsTheOrder) {
  EXPECT_THAT(spread({50, 52, 90}, 10, 0, 100), Pointwise(DoubleNear(1e-9), {46.0, 56.0, 90.0}));
  EXPECT_THAT(spread({50, 50, 50}, 10, 0, 100), Pointwise(DoubleNear(1e-9), {40.0, 50.0, 60.0}));
}

TEST(SpreadApart, StaysBetweenItsEnds) {
  EXPECT_THAT(spread({1, 2, 3}, 10, 0, 100), Pointwise(DoubleNear(1e-9), {0.0, 10.0, 20.0}));
  EXPECT_THAT(spread({99, 98}, 10, 0, 100), Pointwise(DoubleNear(1e-9), {100.0, 90.0}));
}

}  // namespace
}  // namespace handcast::chart
