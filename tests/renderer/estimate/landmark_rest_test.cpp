// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/landmark_rest.hpp"

#include <gtest/gtest.h>

#include <random>

namespace handcast::renderer {
namespace {

/// What is said of landmarks that have moved at a speed for half a second, seen every 10 ms with
/// noise.
float rest_after_moving(float px_s, float noise_px) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, noise_px);
  LandmarkRest rest;
  float share = 0;
  for (int image = 0; image <= 50; ++image) {
    LandmarkPoints seen_px;
    for (auto& point : seen_px)
      point = {300 + px_s * 0.01f * static_cast<float>(image) + noise(random), 200 + noise(random)};
    share = rest.add(1'000'000'000 + 10'000'000LL * image, seen_px);
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
  LandmarkPoints seen_px;
  seen_px.fill({300, 200});
  EXPECT_EQ(LandmarkRest().add(1'000'000'000, seen_px), 0);
}

}  // namespace
}  // namespace handcast::renderer
