// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/gamma.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace handcast::calibrate {
namespace {

using testing::HasSubstr;

/// Three rounds of steps whose light a projector with this setting makes.
std::vector<GreyStep> steps(double gamma_setting, unsigned seed = 1, double brightest = 1,
                            double noise_sd = 0.006) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_sd);
  std::vector<GreyStep> taken;
  for (int round = 0; round < 3; ++round)
    for (int i = 1; i <= 8; ++i) {
      const double level = brightest * i / 9;
      const double share = gamma_setting == 0 ? share_of(level, brightest, 0)
                                              : std::pow(level / brightest, gamma_setting);
      taken.push_back({level, share + noise(random)});
    }
  return taken;
}

TEST(GammaFit, TheExponentIsFound) {
  for (const double gamma : {1.0, 1.8, 2.2, 2.6}) {
    const auto fit = fit_gamma(steps(gamma), 1);
    ASSERT_TRUE(fit) << fit.error().what;
    EXPECT_NEAR(fit->gamma, gamma, 0.05);
  }
}

TEST(GammaFit, SrgbIsToldFromAnExponent) {
  const auto as_in_srgb = fit_gamma(steps(0), 1), power = fit_gamma(steps(1.8), 1);
  ASSERT_TRUE(as_in_srgb && power);
  EXPECT_EQ(as_in_srgb->setting(), 0);
  EXPECT_NEAR(power->setting(), 1.8, 0.05);
}

TEST(GammaFit, OnlyAClearMisfitIsAChange) {
  const auto is_change = [](double setting, double truth, unsigned seed) {
    const auto taken = steps(truth, seed, 1, 0.012);
    return is_clearly_worse(setting, taken, 1, *fit_gamma(taken, 1));
  };
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_FALSE(is_change(0, 2.2, seed)) << "sRGB and 2.2 are the same to a camera";
    EXPECT_FALSE(is_change(2.2, 0, seed));
    for (const double truth : {1.0, 1.8, 2.6}) EXPECT_TRUE(is_change(0, truth, seed)) << truth;
    EXPECT_TRUE(is_change(2.2, 1, seed));
  }
}

TEST(GammaFit, StepsTakenInTheWrongLightDoNotDecide) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto taken = steps(1.8, seed);
    for (auto& step : taken)
      if (any(random) < 0.15) step.share = any(random);
    const auto fit = fit_gamma(taken, 1);
    ASSERT_TRUE(fit) << fit.error().what;
    EXPECT_NEAR(fit->setting(), 1.8, 0.05) << seed;
    EXPECT_TRUE(is_clearly_worse(0, taken, 1, *fit)) << seed;
  }
}

TEST(GammaFit, ADimmedProjectorHasTheSameExponent) {
  const auto fit = fit_gamma(steps(1.8, 1, 0.6), 0.6);
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_NEAR(fit->gamma, 1.8, 0.05);
}

TEST(GammaFit, ItsIntervalHoldsTheTruthInNineOfTenRuns) {
  int held = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto fit = fit_gamma(steps(2.2, seed), 1);
    ASSERT_TRUE(fit);
    held += fit->low <= 2.2 && fit->high >= 2.2;
    EXPECT_LT(fit->high - fit->low, 0.2) << "an interval that says nothing";
  }
  EXPECT_GE(held, 43) << "of 50; the bootstrap of 24 steps is a little narrow";
}

TEST(GammaFit, WhatIsNoCurveIsTold) {
  EXPECT_FALSE(fit_gamma({}, 1));
  auto falling = steps(2.2);
  for (auto& step : falling) step.share = 1 - step.share;
  const auto fit = fit_gamma(falling, 1);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().what, HasSubstr("does not grow"));
  auto saturated = steps(1);
  for (auto& step : saturated) step.share = std::min(1.0, 20 * step.share);
  EXPECT_FALSE(fit_gamma(saturated, 1));
}

TEST(GammaFit, ThePictureHasThePointsAndBothCurves) {
  const auto taken = steps(1.8);
  auto picture = gamma_picture(taken, 1, *fit_gamma(taken, 1), 0);
  EXPECT_EQ(picture.numbers["share"].size(), taken.size());
  const auto &fitted = picture.numbers["fitted"], &set = picture.numbers["set"];
  EXPECT_EQ(fitted.size(), picture.numbers["curve_level"].size());
  EXPECT_EQ(fitted.back(), 1);
  EXPECT_EQ(set.back(), 1);
  EXPECT_NE(fitted[fitted.size() / 2], set[set.size() / 2]);
}

}  // namespace
}  // namespace handcast::calibrate
