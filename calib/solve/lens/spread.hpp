// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "calib/least_squares/normal_equations.hpp"
#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {

/// The Gauss-Newton steps of a bootstrap over views: each of 1000 resamples draws as many of their
/// equations as there are, with repetition. Resamples that do not determine the unknowns are left
/// out. `change`: changes the sum of a resample.
std::vector<Eigen::VectorXd> bootstrap(
    std::span<const NormalEquations> views,
    const std::function<void(NormalEquations& sum, std::mt19937& random)>& change = {});

/// How well the parameters are known, by a bootstrap over the views with one Gauss-Newton step from
/// the full solution. That is the solution of the drawn views but for terms of second order, and
/// takes microseconds. Views are drawn and not corners, since the errors of a view's corners may
/// depend on each other: a bent board, motion. The interval is that of Student's t with one degree
/// of freedom less than there are views; tests/bench/calib_lens.cpp measures how often it holds the
/// truth.
struct Spreads {
  std::array<Spread, 9> spreads;
  LensCovariance covariance{};
};
Spreads spreads_of(std::span<const Points> views, const Solution& solution, Distortion distortion);

}  // namespace handcast::calib
