// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <opencv2/core/matx.hpp>
#include <utility>
#include <vector>

namespace handcast::calib {

/// The sum over views whose normal equations have their `squares`.
template <class Normal>
double squares_of(const std::vector<Normal>& normals) {
  double sum = 0;
  for (const auto& normal : normals) sum += normal.squares;
  return sum;
}

template <int n>
void damp(cv::Matx<double, n, n>& matrix, double by) {
  for (int i = 0; i < n; ++i) matrix(i, i) *= 1 + by;
}

/// When minimise() ends.
struct Effort {
  int rounds;   ///< at most
  double done;  ///< share of the squares by which the last round has changed them at most
};

/// Changes `state` so that its squares are least, by Levenberg and Marquardt's method, and returns
/// its normal equations. `normals_of(state)`: those of all views. `stepped(state, normals,
/// damping)`: the state after one step.
template <class State, class NormalsOf, class Stepped>
auto minimise(State& state, const Effort& effort, const NormalsOf& normals_of,
              const Stepped& stepped) {
  constexpr double kLargestDamping = 1e9;
  auto normals = normals_of(state);
  double damping = 1e-3;
  for (int round = 0; round < effort.rounds && damping < kLargestDamping; ++round) {
    auto next = stepped(state, normals, damping);
    auto next_normals = normals_of(next);
    const double before = squares_of(normals), after = squares_of(next_normals);
    damping *= after < before ? 0.1 : 10;  // NaN is no progress either
    if (after < before) {
      state = std::move(next);
      normals = std::move(next_normals);
    }
    if (std::abs(before - after) <= effort.done * before) break;
  }
  return normals;
}

}  // namespace handcast::calib
