// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <utility>

namespace handcast::calib {

/// When minimise() ends.
struct Effort {
  int steps;    ///< at most, with those that do not decrease the cost
  double done;  ///< a step that decreases the cost by this share or less is the last one
};

/// Changes `state` so that its cost is least, by Levenberg and Marquardt's method, and returns the
/// equations of the result. `equations_at(state)`: its NormalEquations or PartEquations.
/// `moved(state, step)`: the state after a step that the equations gave.
template <class State, class EquationsAt, class Moved>
auto minimise(State& state, const Effort& effort, const EquationsAt& equations_at,
              const Moved& moved) {
  constexpr double kFirstDamping = 1e-3, kMostDamping = 1e9;
  auto equations = equations_at(std::as_const(state));
  double damping = kFirstDamping;
  for (int i = 0; i < effort.steps && damping < kMostDamping; ++i) {
    if (const auto step = equations.step(damping)) {
      State next = moved(std::as_const(state), *step);
      auto next_equations = equations_at(std::as_const(next));
      const double before = equations.cost, after = next_equations.cost;
      if (after < before) {  // not so if it is NaN
        state = std::move(next);
        equations = std::move(next_equations);
        damping *= 0.2;
        if (before - after <= effort.done * before) break;
        continue;
      }
    }
    damping = std::max(10 * damping, kFirstDamping);
  }
  return equations;
}

}  // namespace handcast::calib
