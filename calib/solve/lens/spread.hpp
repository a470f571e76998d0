// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>

#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {

/// Number of times that the bootstrap draws views.
constexpr int kResamples = 1000;

/// How well the parameters are known, by a bootstrap over the views: it draws as many views as
/// there are, with repetition, and takes one Gauss-Newton step from the full solution. That is the
/// solution of the drawn views but for terms of second order, and takes microseconds. Views are
/// drawn and not corners, since the errors of a view's corners may depend on each other: a bent
/// board, motion. The interval is that of Student's t with one degree of freedom less than there
/// are views; tests/bench/calib_lens.cpp measures how often it holds the truth.
struct Spreads {
  std::array<Spread, 9> spreads;
  LensCovariance covariance{};
};
Spreads spreads_of(std::span<const Points> views, const Solution& solution, Distortion distortion);

/// The 97.5 % quantile of Student's t, by the first terms of its expansion in 1 / freedom
/// (Abramowitz and Stegun, 26.7.5).
double students_t(double freedom);

}  // namespace handcast::calib
