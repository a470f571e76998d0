// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "calib/least_squares/levenberg_marquardt.hpp"
#include "calib/least_squares/normal_equations.hpp"

namespace handcast::calib {
namespace {

const Eigen::MatrixXd kJacobian{{2, 1, 0}, {1, -3, 1}, {0, 1, 4}, {1, 1, 1}, {-2, 0, 1}};
const Eigen::Vector3d kSolution{1, -2, 0.5};
const Eigen::VectorXd kNoise{{0.1, -0.2, 0.05, 0.3, -0.1}};

TEST(NormalEquations, StepToTheSolutionOfALinearProblem) {
  const auto equations = NormalEquations::of(kJacobian, kJacobian * kSolution);
  EXPECT_LT((*equations.step() - kSolution).norm(), 1e-12);
  EXPECT_NEAR(equations.cost, (kJacobian * kSolution).squaredNorm(), 1e-12);
}

TEST(NormalEquations, OfSparseRowsAreThoseOfTheWholeMatrix) {
  const Eigen::VectorXd residuals = kJacobian * kSolution + kNoise;
  auto rows = NormalEquations::zero(3);
  for (Eigen::Index i = 0; i < kJacobian.rows(); ++i)
    rows.add(std::array{0, 1, 2}, std::array{kJacobian(i, 0), kJacobian(i, 1), kJacobian(i, 2)},
             residuals[i], 1);
  const auto whole = NormalEquations::of(kJacobian, residuals);
  EXPECT_LT((*rows.step() - *whole.step()).norm(), 1e-12);
  EXPECT_LT((*rows.covariance() - *whole.covariance()).norm(), 1e-12);
}

TEST(NormalEquations, AreSingularIfAnUnknownIsNotDetermined) {
  const Eigen::MatrixXd nearly{{1, 1 + 1e-7}, {1, 1}, {2, 2}}, zero{{1, 0}, {2, 0}};
  const auto dependent = NormalEquations::of(nearly, Eigen::Vector3d::Ones()),
             absent = NormalEquations::of(zero, Eigen::Vector2d(3, 6));
  EXPECT_FALSE(dependent.step() || dependent.covariance());
  EXPECT_FALSE(absent.step());
  const auto damped = *absent.step(1e-3);
  EXPECT_NEAR(damped[0], 3 / 1.001, 1e-12);
  EXPECT_EQ(damped[1], 0);
}

TEST(NormalEquations, ScaleDoesNotMakeThemSingular) {
  const Eigen::Vector3d scale(1e8, 1, 1e-6);
  const auto equations = NormalEquations::of(kJacobian * scale.asDiagonal(), kJacobian * kSolution);
  ASSERT_TRUE(equations.step());
  EXPECT_LT((scale.asDiagonal() * *equations.step() - kSolution).norm(), 1e-9);
}

TEST(NormalEquations, WithoutTheFirstUnknownsGiveTheSameForTheOthers) {
  const auto equations = NormalEquations::of(kJacobian, kJacobian * kSolution + kNoise);
  const Eigen::Vector3d all = *equations.step();
  EXPECT_LT((*equations.without_first(1).step() - all.tail(2)).norm(), 1e-12);
  EXPECT_LT(
      (*equations.without_first(2).covariance() - equations.covariance()->bottomRightCorner(1, 1))
          .norm(),
      1e-12);
}

TEST(PartEquations, StepAsTheEquationsOfTheWholeProblem) {
  // Two parts with two own unknowns each, and one shared: columns 0 1, 2 3, and 4 of the whole.
  const Eigen::VectorXd residuals = kJacobian * kSolution + kNoise;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(10, 5);
  whole.block(0, 0, 5, 2) = kJacobian.leftCols(2);
  whole.block(5, 2, 5, 2) = 2 * kJacobian.leftCols(2);
  whole.col(4) << kJacobian.col(2), kJacobian.col(2);
  Eigen::MatrixXd second = kJacobian;
  second.leftCols(2) *= 2;
  Eigen::VectorXd both(10);
  both << residuals, 3 * residuals;
  PartEquations parts{.own = 2};
  parts.add(NormalEquations::of(kJacobian, residuals));
  parts.add(NormalEquations::of(second, 3 * residuals));
  EXPECT_NEAR(parts.cost, both.squaredNorm(), 1e-12);
  for (const double damping : {0., 0.5}) {
    const auto expected = *NormalEquations::of(whole, both).step(damping);
    const auto step = *parts.step(damping);
    EXPECT_LT((step.own[0] - expected.head(2)).norm(), 1e-12);
    EXPECT_LT((step.own[1] - expected.segment(2, 2)).norm(), 1e-12);
    EXPECT_LT((step.shared - expected.tail(1)).norm(), 1e-12);
  }
}

/// Rosenbrock's valley, whose minimum 0 is at (1, 1).
NormalEquations valley(const Eigen::Vector2d& at) {
  return NormalEquations::of(Eigen::MatrixXd{{-20 * at.x(), 10}, {-1, 0}},
                             Eigen::Vector2d(10 * (at.x() * at.x() - at.y()), at.x() - 1));
}

Eigen::Vector2d sum(const Eigen::Vector2d& at, const Eigen::VectorXd& step) { return at + step; }

TEST(LevenbergMarquardt, FindsTheEndOfACurvedValley) {
  Eigen::Vector2d at(-1.2, 1);
  const auto equations = minimise(at, {.steps = 100, .done = 1e-9}, valley, sum);
  EXPECT_LT((at - Eigen::Vector2d(1, 1)).norm(), 1e-6);
  EXPECT_EQ(equations.cost, valley(at).cost);
}

TEST(LevenbergMarquardt, TakesNoStepThatIncreasesTheCostOrHasNone) {
  Eigen::Vector2d at(-1.2, 1);
  double least = valley(at).cost;
  minimise(
      at, {.steps = 100, .done = 1e-9},
      [&](const Eigen::Vector2d& next) {
        auto equations = valley(next);
        if (next.x() > 0.5) equations.cost = std::numeric_limits<double>::quiet_NaN();
        return equations;
      },
      [&](const Eigen::Vector2d& from, const Eigen::VectorXd& step) {
        EXPECT_LE(valley(from).cost, least);
        least = valley(from).cost;
        return sum(from, step);
      });
  EXPECT_LE(at.x(), 0.5);
  EXPECT_LT(valley(at).cost, 1);
}

TEST(LevenbergMarquardt, EndsAfterItsStepsAndWhereTheCostHardlyDecreases) {
  Eigen::Vector2d few(-1.2, 1), coarse = few;
  int evaluated = 0;
  const auto counted = [&](const Eigen::Vector2d& at) {
    ++evaluated;
    return valley(at);
  };
  minimise(few, {.steps = 3, .done = 0}, counted, sum);
  EXPECT_EQ(evaluated, 4);
  minimise(coarse, {.steps = 100, .done = 0.9999}, counted, sum);
  EXPECT_GT(valley(coarse).cost, 1e-3);
}

}  // namespace
}  // namespace handcast::calib
