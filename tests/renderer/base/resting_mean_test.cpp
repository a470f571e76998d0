// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/resting_mean.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace handcast::renderer {
namespace {

constexpr std::int64_t kStep_ns = 5'000'000;
constexpr int kSecond = 200;  ///< steps

TEST(RestingMean, TheFirstVectorIsItsOwnMean) {
  RestingMean mean;
  EXPECT_EQ(mean.add(0, {3, -4}, {100, 100}), glm::vec2(3, -4));
}

TEST(RestingMean, AVectorThatSwaysAtAPointAtRestIsHeld) {
  RestingMean mean;
  float least = 10, most = 0;
  for (int i = 0; i < 6 * kSecond; ++i) {
    const float sway =
        3 * std::sin(2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSecond);
    const float x = mean.add(i * kStep_ns, {5 + sway, 0}, {100, 100}).x;
    if (i > 4 * kSecond) least = std::min(least, x), most = std::max(most, x);
  }
  EXPECT_LT(most - least, 0.6f);
  EXPECT_NEAR(0.5f * (least + most), 5, 0.5f);
}

TEST(RestingMean, AMovingPointHasAnotherVectorSoon) {
  RestingMean mean;
  for (int i = 0; i < 2 * kSecond; ++i) mean.add(i * kStep_ns, {5, 0}, {100, 100});
  glm::vec2 last{0};
  for (int i = 1; i <= kSecond / 4; ++i)
    last = mean.add((2 * kSecond + i) * kStep_ns, {0, 0}, {100 + 2 * i, 100});
  EXPECT_LT(last.x, 0.1f);
}

TEST(RestingMean, AfterForgettingTheNextVectorIsTheMean) {
  RestingMean mean;
  for (int i = 0; i < kSecond; ++i) mean.add(i * kStep_ns, {5, 0}, {100, 100});
  mean.forget();
  EXPECT_EQ(mean.add(kSecond * kStep_ns, {1, 1}, {100, 100}), glm::vec2(1, 1));
}

TEST(RestingMean, ATimeThatGoesBackChangesNothing) {
  RestingMean mean;
  for (int i = 0; i < kSecond; ++i) mean.add(i * kStep_ns, {5, 0}, {100, 100});
  EXPECT_EQ(mean.add(0, {50, 0}, {100, 100}), glm::vec2(5, 0));
}

}  // namespace
}  // namespace handcast::renderer
