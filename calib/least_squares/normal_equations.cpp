// SPDX-License-Identifier: Apache-2.0
#include "calib/least_squares/normal_equations.hpp"

#include <Eigen/Cholesky>

namespace handcast::calib {
namespace {

/// Cholesky's factors of a matrix whose rows and columns are scaled to a diagonal of 1: what
/// elimination leaves of the diagonal then tells how far the matrix is from singular.
class Factors {
 public:
  Factors(const Eigen::MatrixXd& matrix, double damping)
      : scale_((matrix.diagonal().array() > 0)
                   .select(matrix.diagonal().cwiseSqrt().cwiseInverse(), 0)) {
    Eigen::MatrixXd scaled = scale_.asDiagonal() * matrix * scale_.asDiagonal();
    scaled.diagonal().array() += damping;
    factors_.compute(scaled);
  }

  bool are_regular() const {
    constexpr double kSingular = 1e-9;
    if (factors_.info() != Eigen::Success) return false;
    const double least = factors_.matrixLLT().diagonal().minCoeff();
    return least * least > kSingular;
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const {
    return scale_.asDiagonal() * factors_.solve(scale_.asDiagonal() * right);
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> factors_;
};

}  // namespace

NormalEquations NormalEquations::zero(Eigen::Index unknowns) {
  return {Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)};
}

NormalEquations NormalEquations::of(const Eigen::MatrixXd& jacobian,
                                    const Eigen::VectorXd& residuals) {
  return {jacobian.transpose() * jacobian, jacobian.transpose() * residuals,
          residuals.squaredNorm()};
}

void NormalEquations::add(const NormalEquations& other, double weight) {
  matrix += weight * other.matrix;
  slope += weight * other.slope;
  cost += weight * other.cost;
}

void NormalEquations::add(std::span<const int> columns, std::span<const double> derivatives,
                          double residual, double weight) {
  for (std::size_t a = 0; a < columns.size(); ++a) {
    const double scaled = weight * derivatives[a];
    slope[columns[a]] += scaled * residual;
    for (std::size_t b = 0; b <= a; ++b) matrix(columns[a], columns[b]) += scaled * derivatives[b];
  }
}

std::optional<Eigen::VectorXd> NormalEquations::step(double damping) const {
  const Factors factors(matrix, damping);
  if (!factors.are_regular()) return std::nullopt;
  return factors.solve(slope);
}

std::optional<Eigen::MatrixXd> NormalEquations::covariance() const {
  const Factors factors(matrix, 0);
  if (!factors.are_regular()) return std::nullopt;
  return factors.solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

NormalEquations NormalEquations::of_first(Eigen::Index count) const {
  return {matrix.topLeftCorner(count, count), slope.head(count), cost};
}

NormalEquations NormalEquations::without_first(Eigen::Index count) const {
  const Eigen::Index rest = slope.size() - count;
  const Eigen::MatrixXd across = matrix.bottomLeftCorner(rest, count);
  const Eigen::LLT<Eigen::MatrixXd> own(matrix.topLeftCorner(count, count));
  return {matrix.bottomRightCorner(rest, rest) - across * own.solve(across.transpose()),
          slope.tail(rest) - across * own.solve(slope.head(count)), cost};
}

void PartEquations::add(NormalEquations part) {
  cost += part.cost;
  parts.push_back(std::move(part));
}

std::optional<PartEquations::Step> PartEquations::step(double damping) const {
  auto damped = parts;
  auto shared = NormalEquations::zero(parts.front().slope.size() - own);
  for (auto& part : damped) {
    part.matrix.diagonal() *= 1 + damping;
    shared.add(part.without_first(own));
  }
  const auto shared_step = shared.step();
  if (!shared_step) return std::nullopt;
  Step step{*shared_step, {}};
  for (auto& part : damped) {
    auto rest = part.of_first(own);
    rest.slope -= part.matrix.bottomLeftCorner(shared_step->size(), own).transpose() * *shared_step;
    const auto own_step = rest.step();
    if (!own_step) return std::nullopt;
    step.own.push_back(*own_step);
  }
  return step;
}

}  // namespace handcast::calib
