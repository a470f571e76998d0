// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/lasting.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace handcast::calib {
namespace {

constexpr double kStep_s = 0.25, kBlock_s = 0.25;

/// Three coordinates of errors with a variance of 1 that are forgotten to 1/e in `lasting_s`,
/// measured with `noise`.
std::array<std::vector<Measured>, 3> errors(double lasting_s, double seconds, double noise,
                                            unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::array<std::vector<Measured>, 3> coordinates;
  const double kept = std::exp(-kStep_s / lasting_s);
  for (auto& series : coordinates) {
    double error = normal(random);
    for (double s = 0; s < seconds; s += kStep_s) {
      series.push_back({error + noise * normal(random), noise * noise});
      error = kept * error + std::sqrt(1 - kept * kept) * normal(random);
    }
  }
  return coordinates;
}

double mean_of(double lasting_s, double seconds, double noise) {
  constexpr unsigned kSeeds = 40;
  double sum = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed)
    sum += variance_of_mean(errors(lasting_s, seconds, noise, seed), kStep_s, kBlock_s);
  return sum / kSeeds;
}

/// Of the mean of such errors, for a variance of 1 (less what the blocks of one step see).
double truth(double lasting_s, double seconds) {
  const double share = lasting_s / seconds;
  return 2 * share * (1 - share * (1 - std::exp(-1 / share)));
}

TEST(LastingErrors, TheVarianceOfTheirMeanIsFoundForAnyDuration) {
  for (const double lasting_s : {0.5, 1.5, 5.0}) {
    const double found = mean_of(lasting_s, 15, 0.1), real = truth(lasting_s, 15);
    EXPECT_GT(found, 0.6 * real) << lasting_s;
    EXPECT_LT(found, 2.0 * real) << lasting_s;
  }
}

TEST(LastingErrors, NoiseOfTheMeasurementIsNotTakenForThem) {
  const double quiet = mean_of(1.5, 30, 0.1), noisy = mean_of(1.5, 30, 1);
  EXPECT_NEAR(noisy / quiet, 1, 0.5);
}

TEST(LastingErrors, AConstantErrorIsNotSeen) {
  auto shifted = errors(1.5, 15, 0.1, 1);
  const double before = variance_of_mean(shifted, kStep_s, kBlock_s);
  for (auto& series : shifted)
    for (auto& measured : series) measured.value += 7;
  EXPECT_NEAR(variance_of_mean(shifted, kStep_s, kBlock_s), before, 1e-6 * before);
}

TEST(LastingErrors, TheSizeOfTheErrorsCounts) {
  auto large = errors(1.5, 15, 0.1, 1);
  const double before = variance_of_mean(large, kStep_s, kBlock_s);
  for (auto& series : large)
    for (auto& measured : series) measured = {3 * measured.value, 9 * measured.variance};
  EXPECT_NEAR(variance_of_mean(large, kStep_s, kBlock_s), 9 * before, 1e-6 * before);
}

TEST(LastingErrors, TimesWithoutAMeasurementAreNoErrorsOfZero) {
  auto holey = errors(5, 15, 0.1, 1);
  const double before = variance_of_mean(holey, kStep_s, kBlock_s);
  for (auto& series : holey)
    for (std::size_t i = 0; i < series.size(); i += 2)
      series[i] = {0, std::numeric_limits<double>::infinity()};
  EXPECT_NEAR(variance_of_mean(holey, kStep_s, kBlock_s) / before, 1, 0.4);
}

TEST(LastingErrors, WhatBlocksSeeIsLeftOut) {
  const auto some = errors(0.5, 30, 0.1, 1);
  EXPECT_LT(variance_of_mean(some, kStep_s, 2.5), 0.5 * variance_of_mean(some, kStep_s, 0.05));
}

TEST(LastingErrors, WithoutAnyThereIsNone) {
  EXPECT_EQ(variance_of_mean({}, kStep_s, kBlock_s), 0);
  const std::array<std::vector<Measured>, 3> none;
  EXPECT_EQ(variance_of_mean(none, kStep_s, kBlock_s), 0);
}

}  // namespace
}  // namespace handcast::calib
