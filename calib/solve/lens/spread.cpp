// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/spread.hpp"

#include <cmath>
#include <random>

#include "calib/solve/lens/normal.hpp"

namespace handcast::calib {
namespace {

LensMatrix total_of(const std::vector<Statement>& statements) {
  LensMatrix total;
  for (const auto& statement : statements) total += statement.matrix;
  return total;
}

/// Gives all parameters the same scale, without which the products of focal lengths and
/// coefficients cannot be inverted. Returns the scale of each.
LensVector equalise(std::vector<Statement>& statements) {
  const auto total = total_of(statements);
  LensVector scale;
  for (int i = 0; i < scale.rows; ++i) scale[i] = std::sqrt(total(i, i));
  for (auto& statement : statements) {
    for (int i = 0; i < scale.rows; ++i)
      for (int j = 0; j < scale.rows; ++j) statement.matrix(i, j) /= scale[i] * scale[j];
    for (int i = 0; i < scale.rows; ++i) statement.slope[i] /= scale[i];
  }
  return scale;
}

/// The change of the parameters in each resample whose views determine them.
std::vector<LensVector> resample(const std::vector<Statement>& statements) {
  std::mt19937 random(1);
  std::vector<LensVector> changes;
  for (int i = 0; i < kResamples; ++i) {
    Statement sum{};
    for (std::size_t draw = 0; draw < statements.size(); ++draw) {
      const auto& drawn = statements[random() % statements.size()];
      sum.matrix += drawn.matrix;
      sum.slope += drawn.slope;
    }
    bool determined = false;
    const LensMatrix inverse = sum.matrix.inv(cv::DECOMP_CHOLESKY, &determined);
    if (determined) changes.push_back(inverse * sum.slope);
  }
  return changes;
}

double covariance_of(const std::vector<LensVector>& changes, int one, int other) {
  double sum = 0;
  for (const auto& change : changes) sum += change[one] * change[other];
  return sum / static_cast<double>(changes.size());
}

}  // namespace

double students_t(double freedom) {
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom);
}

Spreads spreads_of(std::span<const Points> views, const Solution& solution, Distortion distortion) {
  std::vector<Statement> statements;
  for (std::size_t i = 0; i < views.size(); ++i)
    statements.push_back(
        statement_of(normal_of(views[i], solution.poses[i], solution.camera, distortion)));
  const auto scale = equalise(statements);
  const auto changes = resample(statements);
  const auto values = values_of(solution.camera);
  const double t = students_t(static_cast<double>(views.size()) - 1);
  Spreads found;
  for (int i = 0; i < free_parameters(distortion); ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (int j = 0; j < free_parameters(distortion); ++j)
      found.covariance[at][static_cast<std::size_t>(j)] =
          covariance_of(changes, i, j) / (scale[i] * scale[j]);
    auto& spread = found.spreads[at];
    spread.deviation = std::sqrt(found.covariance[at][at]);
    spread.low = values[i] - t * spread.deviation;
    spread.high = values[i] + t * spread.deviation;
  }
  return found;
}

}  // namespace handcast::calib
