// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/landmark_rest.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace handcast::renderer {
namespace {

msg::HandLandmarks seen(float x_px) {
  msg::HandLandmarks seen;
  seen.points.fill({x_px, 200, 1, 2});
  return seen;
}

/// What is said of landmarks that have moved at a speed for half a second, seen every 10 ms with
/// noise.
float rest_after_moving(float px_s, float noise_px) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, noise_px);
  LandmarkRest rest;
  float share = 0;
  for (int image = 0; image <= 50; ++image) {
    const float moved_px = px_s * 0.01f * static_cast<float>(image);
    auto noisy = seen(300 + moved_px);
    for (auto& point : noisy.points) point.x_px += noise(random), point.y_px += noise(random);
    share = rest.add(1'000'000'000 + 10'000'000LL * image, noisy);
  }
  return share;
}

TEST(LandmarkRest, LandmarksThatTrembleRest) { EXPECT_EQ(rest_after_moving(0, 0.3f), 1); }

TEST(LandmarkRest, LandmarksThatMoveDoNot) { EXPECT_EQ(rest_after_moving(25, 0), 0); }

TEST(LandmarkRest, SlowOnesRestByAPart) {
  EXPECT_GT(rest_after_moving(12, 0), 0.1f);
  EXPECT_LT(rest_after_moving(12, 0), 0.9f);
}

TEST(LandmarkRest, TheFirstImageShowsNoRest) {
  EXPECT_EQ(LandmarkRest().add(1'000'000'000, seen(300)), 0);
}

TEST(LandmarkRest, LandmarksThatAreNotSeenDoNotCountAndFewAreNoRest) {
  LandmarkRest rest;
  auto partly = seen(300);
  const auto hide = [&partly](int first, int end) {
    for (int i = first; i < end; ++i)
      partly.points[i] = {std::numeric_limits<float>::quiet_NaN(), 0, 0, 0};
  };
  hide(0, 10);
  float share = 0;
  std::int64_t time_ns = 1'000'000'000;
  for (int image = 0; image < 100; ++image) share = rest.add(time_ns += 10'000'000, partly);
  EXPECT_EQ(share, 1);
  hide(10, 11);
  EXPECT_EQ(rest.add(time_ns += 10'000'000, partly), 0);
}

}  // namespace
}  // namespace handcast::renderer
