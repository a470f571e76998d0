// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

namespace handcast {
namespace {

TEST(Statistics, TheMedianOfAnEvenNumberIsTheUpperMiddleValue) {
  EXPECT_EQ(median(std::vector{3, 1, 2}), 2);
  EXPECT_EQ(median(std::array{4.0, 1.0, 3.0, 2.0}), 3);
  EXPECT_EQ(median(std::vector<double>{}), 0);
}

TEST(Statistics, AQuantileIsTheNearestRank) {
  const std::vector values{50, 10, 40, 20, 30};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 0.2), 10);
  EXPECT_EQ(quantile(values, 0.21), 20);
  EXPECT_EQ(quantile(values, 0.95), 50);
  EXPECT_EQ(quantile(values, 1), 50);
  EXPECT_EQ(quantile(std::vector<double>{}, 0.5), 0);
}

TEST(Statistics, OnlyTheValuesOfASpanChangeTheirOrder) {
  std::vector values{5, 4, 3, 2, 1};
  median(values);
  EXPECT_EQ(values.front(), 5);
  EXPECT_EQ(median(std::span(values).first(3)), 4);
}

TEST(Statistics, StudentsTIsThatOfTheTables) {
  EXPECT_NEAR(students_t(4), 2.776, 0.03);
  EXPECT_NEAR(students_t(10), 2.228, 0.002);
  EXPECT_NEAR(students_t(1e6), 1.960, 0.001);
}

}  // namespace
}  // namespace handcast
