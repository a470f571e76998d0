// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace handcast::calib {

/// The normal equations of a least-squares problem, linearised at one place: matrix * step = slope.
/// J: the derivatives of the predicted values; r: measured less predicted values; W: the inverse
/// covariance of r.
struct NormalEquations {
  Eigen::MatrixXd matrix;  ///< J^T W J; only its lower triangle is read
  Eigen::VectorXd slope;   ///< J^T W r
  double cost = 0;         ///< r^T W r, or what a robust fit minimises instead

  static NormalEquations zero(Eigen::Index unknowns);
  static NormalEquations of(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals);

  /// Adds the equations of other values, which count `weight` times.
  void add(const NormalEquations& other, double weight = 1);
  /// Adds one row of J, which is 0 but for `derivatives` in these columns, which ascend. Does not
  /// change the cost.
  void add(std::span<const int> columns, std::span<const double> derivatives, double residual,
           double weight);

  /// The step to the solution; with `damping`, that of Levenberg and Marquardt, whose diagonal is
  /// larger by this share. With damping, an unknown that nothing determines does not move; else
  /// nothing is returned if the matrix is singular.
  std::optional<Eigen::VectorXd> step(double damping = 0) const;
  /// The inverse of the matrix; nothing if it is singular.
  std::optional<Eigen::MatrixXd> covariance() const;

  /// The equations of the first `count` unknowns if the others do not change.
  NormalEquations of_first(Eigen::Index count) const;
  /// The equations of the other unknowns, whatever the first `count` are (Schur complement).
  NormalEquations without_first(Eigen::Index count) const;
};

/// The normal equations of a problem of many parts. Each part has unknowns of its own, which come
/// first in its equations; the rest is shared by all. The time of a step grows with the number of
/// parts and not with its cube.
struct PartEquations {
  Eigen::Index own = 0;  ///< number of unknowns that each part has alone
  std::vector<NormalEquations> parts;
  double cost = 0;  ///< the sum over the parts

  void add(NormalEquations part);

  struct Step {
    Eigen::VectorXd shared;
    std::vector<Eigen::VectorXd> own;  ///< of each part
  };
  /// As NormalEquations::step().
  std::optional<Step> step(double damping = 0) const;
};

}  // namespace handcast::calib
