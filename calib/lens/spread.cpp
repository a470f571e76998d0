// SPDX-License-Identifier: Apache-2.0
#include "calib/lens/spread.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/calib3d.hpp>
#include <random>

namespace handcast::calib {
namespace {

constexpr int kPoseColumns = 6, kLensColumns = 9;

/// Number of parameters that are fitted; they are the first of kLensParameters.
int count_of(Distortion distortion) {
  constexpr std::array kCounts{4, 5, 6, 8, 9};
  return kCounts[static_cast<std::size_t>(distortion)];
}

/// What one view says about the camera after its pose is eliminated (Schur complement): the normal
/// matrix and the gradient of the squared residuals' half.
struct Statement {
  cv::Mat1d matrix, score;
};

Statement statement_of(const Points& view, const Pose& pose, const CameraModel& camera,
                       int parameters) {
  std::vector<cv::Point2f> expected_px;
  cv::Mat slopes;
  cv::projectPoints(view.board_m, pose.turn, pose.move, matrix_of(camera), lens_of(camera),
                    expected_px, slopes);
  cv::Mat1d residual(2 * static_cast<int>(expected_px.size()), 1);
  for (std::size_t i = 0; i < expected_px.size(); ++i) {
    residual(2 * static_cast<int>(i)) = view.image_px[i].x - expected_px[i].x;
    residual(2 * static_cast<int>(i) + 1) = view.image_px[i].y - expected_px[i].y;
  }
  const cv::Mat1d by_pose = slopes.colRange(0, kPoseColumns);
  const cv::Mat1d by_lens = slopes.colRange(kPoseColumns, kPoseColumns + parameters);
  cv::Mat1d followed;  // by how much the pose follows a change of each parameter
  cv::solve(by_pose.t() * by_pose, by_pose.t() * by_lens, followed, cv::DECOMP_SVD);
  const cv::Mat1d own = by_lens - by_pose * followed;
  return {own.t() * own, own.t() * residual};
}

std::vector<Statement> statements_of(std::span<const Points> views, const Solution& solution,
                                     int parameters) {
  std::vector<Statement> statements;
  for (std::size_t i = 0; i < views.size(); ++i)
    statements.push_back(statement_of(views[i], solution.poses[i], solution.camera, parameters));
  return statements;
}

cv::Mat1d total_of(const std::vector<Statement>& statements, int parameters) {
  cv::Mat1d total = cv::Mat1d::zeros(parameters, parameters);
  for (const auto& statement : statements) total += statement.matrix;
  return total;
}

/// Gives all parameters the same scale, without which the products of focal lengths and
/// coefficients cannot be inverted. Returns the scale of each.
cv::Mat1d equalise(std::vector<Statement>& statements, int parameters) {
  cv::Mat1d scale;
  cv::sqrt(total_of(statements, parameters).diag(), scale);
  for (auto& statement : statements) {
    statement.matrix /= scale * scale.t();
    statement.score /= scale;
  }
  return scale;
}

/// Replaces each score by that which the fit without this view would have seen.
void unfollow(std::vector<Statement>& statements, int parameters) {
  const auto total = total_of(statements, parameters);
  cv::Mat1d mean = cv::Mat1d::zeros(parameters, 1);
  for (auto& statement : statements) {
    cv::Mat1d step;
    cv::solve(total - statement.matrix, statement.score, step, cv::DECOMP_SVD);
    statement.score = total * step;
    mean += statement.score / static_cast<double>(statements.size());
  }
  for (auto& statement : statements) statement.score -= mean;
}

/// The change of the parameters in each resample, one column each.
std::vector<cv::Mat1d> resample(const std::vector<Statement>& statements, int parameters) {
  std::mt19937 random(1);
  std::vector<cv::Mat1d> changes;
  for (int i = 0; i < kResamples; ++i) {
    Statement sum{cv::Mat1d::zeros(parameters, parameters), cv::Mat1d::zeros(parameters, 1)};
    for (std::size_t draw = 0; draw < statements.size(); ++draw) {
      const auto& drawn = statements[random() % statements.size()];
      sum.matrix += drawn.matrix;
      sum.score += drawn.score;
    }
    cv::Mat1d change;
    if (cv::solve(sum.matrix, sum.score, change, cv::DECOMP_CHOLESKY)) changes.push_back(change);
  }
  return changes;
}

/// The 97.5 % quantile of Student's t, by the first terms of its expansion in 1 / freedom
/// (Abramowitz and Stegun, 26.7.5).
double students_t(double freedom) {
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * freedom) + (5 * z5 + 16 * z3 + 3 * z) / (96 * freedom * freedom);
}

double deviation_of(const std::vector<cv::Mat1d>& changes, int parameter) {
  double squares = 0;
  for (const auto& change : changes) squares += change(parameter) * change(parameter);
  return std::sqrt(squares / static_cast<double>(changes.size()));
}

}  // namespace

std::array<Spread, 9> spreads_of(std::span<const Points> views, const Solution& solution,
                                 Distortion distortion) {
  const int parameters = count_of(distortion);
  auto statements = statements_of(views, solution, parameters);
  const auto scale = equalise(statements, parameters);
  unfollow(statements, parameters);
  const auto changes = resample(statements, parameters);
  const auto& c = solution.camera;
  const std::array values{c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
  const double t = students_t(static_cast<double>(views.size()) - 1);
  std::array<Spread, 9> spreads;
  for (int i = 0; i < parameters; ++i) {
    auto& spread = spreads[static_cast<std::size_t>(i)];
    const double value = values[static_cast<std::size_t>(i)];
    spread.deviation = deviation_of(changes, i) / scale(i);
    spread.low = value - t * spread.deviation;
    spread.high = value + t * spread.deviation;
  }
  return spreads;
}

}  // namespace handcast::calib
