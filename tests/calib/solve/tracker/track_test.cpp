// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace handcast::calib {
namespace {

glm::dvec3 place(double s) { return {0.05 * std::sin(8 * s), 0.3 * s, 0.04 * std::cos(5 * s)}; }
glm::dvec3 velocity(double s) { return {0.4 * std::cos(8 * s), 0.3, -0.2 * std::sin(5 * s)}; }

Track track(double hz, double noise_m = 0) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<double> times_s;
  std::vector<std::vector<glm::dvec3>> points_m;
  for (double s = 0; s <= 4; s += 1 / hz) {
    times_s.push_back(s);
    points_m.push_back(
        {place(s) + noise_m * glm::dvec3(noise(random), noise(random), noise(random))});
  }
  return {times_s, points_m};
}

TEST(Track, FollowsAMovingPointBetweenTheSamples) {
  const std::vector<std::pair<double, double>> rates{{30, 1e-4}, {90, 1e-4}, {110, 1e-4}};
  for (const auto& [hz, limit_m] : rates) {
    const auto hand = track(hz);
    for (double s = 0.1; s < 3.9; s += 0.0037) {
      const auto moving = hand.at(0, s);
      ASSERT_TRUE(moving);
      EXPECT_LT(glm::distance(moving->at_m, place(s)), limit_m) << hz << " Hz at " << s;
      EXPECT_LT(glm::distance(moving->velocity_m_s, velocity(s)), 0.02) << hz << " Hz at " << s;
    }
  }
}

TEST(Track, NoiseDoesNotDependOnThePhaseBetweenTwoSamples) {
  const auto hand = track(90, 0.001);
  double on_sample = 0, between = 0;
  for (int i = 10; i < 340; ++i) {
    const auto on = hand.at(0, i / 90. + 1e-9), half = hand.at(0, (i + 0.5) / 90);
    ASSERT_TRUE(on && half);
    on_sample += std::pow(glm::distance(on->at_m, place(i / 90.)), 2);
    between += std::pow(glm::distance(half->at_m, place((i + 0.5) / 90)), 2);
  }
  EXPECT_NEAR(between / on_sample, 1, 0.15);
  EXPECT_LT(std::sqrt(on_sample / 330), 0.7 * 0.001 * std::sqrt(3.));
}

TEST(Track, HasNoPositionOutsideTheSamplesNorInAGap) {
  std::vector<double> times_s;
  std::vector<std::vector<glm::dvec3>> points_m;
  for (double s = 0; s < 2; s += 0.01)
    if (s < 0.8 || s > 1.2) {
      times_s.push_back(s);
      points_m.push_back({place(s)});
    }
  const Track hand(times_s, points_m);
  EXPECT_FALSE(hand.at(0, -0.001));
  EXPECT_FALSE(hand.at(0, 2.1));
  EXPECT_FALSE(hand.at(0, 1.0));
  EXPECT_TRUE(hand.at(0, 0.5));
  ASSERT_TRUE(hand.at(0, 0.785));
  EXPECT_LT(glm::distance(hand.at(0, 0.785)->at_m, place(0.785)), 2e-4);
}

TEST(Track, ASampleAloneOrInAPairGivesNoWildVelocity) {
  const Track hand({0, 1, 1.05, 2}, {{place(0)}, {place(1)}, {place(1.05)}, {place(2)}});
  const auto moving = hand.at(0, 1.02);
  ASSERT_TRUE(moving);
  EXPECT_LT(glm::distance(moving->at_m, place(1.02)), 0.005);
  EXPECT_LT(glm::length(moving->velocity_m_s), 1);
}

TEST(Track, OnlyAHandOf21PointsCanBeMirrored) { EXPECT_FALSE(track(90).mirrored_hand()); }

}  // namespace
}  // namespace handcast::calib
