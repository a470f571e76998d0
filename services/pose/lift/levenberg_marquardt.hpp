// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace handcast::pose {

/// The normal equations of a linear least-squares problem with `n` unknowns.
template <int n>
class NormalEquations {
 public:
  using Vector = std::array<double, n>;

  /// Adds the residual `r` with its derivative; `weight`: its inverse variance. Only the `count`
  /// columns `at` of the derivative are not 0; they must ascend.
  void add(const int* at, const double* derivative, int count, double r, double weight) {
    for (int a = 0; a < count; ++a) {
      const double scaled = weight * derivative[a];
      gradient_[at[a]] += scaled * r;
      for (int b = 0; b <= a; ++b) matrix_[at[a]][at[b]] += scaled * derivative[b];
    }
  }
  /// The same with one column, whose derivative is 1.
  void add(int at, double r, double weight) {
    gradient_[at] += weight * r;
    matrix_[at][at] += weight;
  }

  /// The variances of the unknowns: the diagonal of the inverse matrix. Empty if it is not positive
  /// definite.
  std::optional<Vector> variances() const {
    auto l = matrix_;
    if (!decompose(l)) return std::nullopt;
    Vector variances{};
    for (int column = 0; column < n; ++column) {
      Vector x{};  // column of the inverse of L
      for (int i = column; i < n; ++i) {
        double sum = i == column ? 1 : 0;
        for (int k = column; k < i; ++k) sum -= l[i][k] * x[k];
        x[i] = sum / l[i][i];
        variances[column] += x[i] * x[i];
      }
    }
    return variances;
  }

  /// The step that minimises the sum, by Cholesky's method, with the diagonal increased by the
  /// share `damping`. Empty if the matrix is not positive definite.
  std::optional<Vector> step(double damping) const {
    auto l = matrix_;
    for (int i = 0; i < n; ++i) l[i][i] += damping * l[i][i] + 1e-9;
    if (!decompose(l)) return std::nullopt;
    Vector x;
    for (int i = 0; i < n; ++i) {
      double sum = -gradient_[i];
      for (int k = 0; k < i; ++k) sum -= l[i][k] * x[k];
      x[i] = sum / l[i][i];
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) x[i] -= l[k][i] * x[k];
      x[i] /= l[i][i];
    }
    return x;
  }

 private:
  using Matrix = std::array<std::array<double, n>, n>;

  /// Cholesky's decomposition in place. False if the matrix is not positive definite.
  static bool decompose(Matrix& l) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = l[i][j];
        for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
        if (i == j && !(sum > 0)) return false;
        l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
      }
    return true;
  }

  Matrix matrix_{};  ///< lower triangle
  Vector gradient_{};
};

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
