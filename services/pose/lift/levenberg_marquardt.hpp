// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>

#include "services/pose/lift/normal_equations.hpp"

namespace handcast::pose {

/// A state at which a cost is small.
template <class State, int n>
struct Minimum {
  State state;
  double cost = 0;
  std::array<double, n> variance{};  ///< of the state; 0 where nothing determines it
};

/// Minimises a sum of squares by Levenberg and Marquardt's method, in at most `steps` steps from
/// `start`. `problem.at(state, equations)` is the cost of a state; it adds to the equations if they
/// are not null. `moved(state, step)` takes a step. `most(i)`: the longest step of unknown i for
/// which the linearisation is good.
template <int n, class State, class Problem, class Most>
Minimum<State, n> minimise(Problem& problem, const State& start, int steps, Most&& most) {
  Minimum<State, n> best{start, problem.at(start, nullptr), {}};
  double damping = 1e-3;
  for (int i = 0; i < steps; ++i) {
    NormalEquations<n> equations;
    problem.at(best.state, &equations);
    auto step = equations.step(damping);
    for (int k = 0; step && k < n; ++k) (*step)[k] = std::clamp((*step)[k], -most(k), most(k));
    const State next = step ? moved(best.state, *step) : best.state;
    const double cost = problem.at(next, nullptr);
    if (!step || !(cost < best.cost)) {
      damping = std::max(10 * damping, 1e-3);
      continue;
    }
    const bool is_done = best.cost - cost < 1e-3 * best.cost;
    best.state = next, best.cost = cost;
    damping *= 0.2;
    if (is_done) break;
  }
  NormalEquations<n> equations;
  problem.at(best.state, &equations);
  best.variance = equations.variances().value_or(std::array<double, n>{});
  return best;
}

}  // namespace handcast::pose
