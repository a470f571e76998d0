// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/solve.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "calib/least_squares/levenberg_marquardt.hpp"
#include "calib/solve/lens/normal.hpp"

namespace handcast::calib {
namespace {

PartEquations equations_at(std::span<const Points> views, Distortion distortion,
                           const Solution& at) {
  PartEquations equations{.own = kPoseNumbers};
  for (std::size_t i = 0; i < views.size(); ++i)
    equations.add(normal_of(views[i], at.poses[i], at.camera, distortion));
  return equations;
}

Solution moved(Solution solution, const PartEquations::Step& step) {
  for (Eigen::Index i = 0; i < step.shared.size(); ++i)
    solution.camera.*kLensFields[static_cast<std::size_t>(i)] += step.shared[i];
  for (std::size_t i = 0; i < solution.poses.size(); ++i) move(solution.poses[i], step.own[i]);
  return solution;
}

}  // namespace

Points points_of(const BoardView& view) {
  Points points;
  for (const auto& m : view.board_m) points.board_m.emplace_back(m.x, m.y, m.z);
  for (const auto& px : view.image_px) points.image_px.emplace_back(px.x, px.y);
  return points;
}

glm::dmat4 matrix_of(const Pose& pose) {
  cv::Matx33d turn;
  cv::Rodrigues(pose.turn, turn);
  glm::dmat4 matrix(1);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = turn(row, column);
    matrix[3][row] = pose.move[row];
  }
  return matrix;
}

cv::Matx33d matrix_of(const CameraModel& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

cv::Vec<double, 5> lens_of(const CameraModel& camera) {
  return {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
}

std::optional<Solution> first_guess(std::span<const Points> views, int width_px, int height_px) {
  std::vector<std::vector<cv::Point3f>> board_m;
  std::vector<std::vector<cv::Point2f>> image_px;
  for (const auto& view : views) {
    board_m.emplace_back(view.board_m.begin(), view.board_m.end());
    image_px.emplace_back(view.image_px.begin(), view.image_px.end());
  }
  Solution guess;
  try {
    const cv::Matx33d k = cv::initCameraMatrix2D(board_m, image_px, {width_px, height_px}, 0);
    guess.camera = {width_px, height_px, k(0, 0), k(1, 1), k(0, 2), k(1, 2)};
  } catch (const cv::Exception&) {  // of views that have no solution
    return {};
  }
  if (!std::isfinite(guess.camera.fx_px + guess.camera.fy_px)) return {};
  for (const auto& view : views) {
    const auto placed = place(view, guess.camera);
    if (!placed) return {};
    guess.poses.push_back(placed->pose);
    guess.rms_px.push_back(placed->rms_px);
  }
  return guess;
}

std::optional<Solution> solve(std::span<const Points> views, Distortion distortion,
                              const Solution& start) {
  constexpr Effort kEffort{100, 1e-7};
  Solution best = start;
  for (int i = free_parameters(distortion); i < kLensNumbers; ++i)
    best.camera.*kLensFields[static_cast<std::size_t>(i)] = 0;
  const auto equations = minimise(
      best, kEffort, [&](const Solution& at) { return equations_at(views, distortion, at); },
      moved);
  if (!(best.camera.fx_px > 0 && best.camera.fy_px > 0 && std::isfinite(equations.cost))) return {};
  for (std::size_t i = 0; i < views.size(); ++i)
    best.rms_px[i] =
        std::sqrt(equations.parts[i].cost / static_cast<double>(views[i].image_px.size()));
  return best;
}

std::optional<Placed> place(const Points& view, const CameraModel& camera) {
  Placed placed;
  const auto matrix = matrix_of(camera);
  const auto lens = lens_of(camera);
  std::vector<cv::Point2d> expected_px;
  try {
    if (!cv::solvePnP(view.board_m, view.image_px, matrix, lens, placed.pose.turn,
                      placed.pose.move))
      return {};
    cv::projectPoints(view.board_m, placed.pose.turn, placed.pose.move, matrix, lens, expected_px);
  } catch (const cv::Exception&) {  // of points that have no pose
    return {};
  }
  placed.rms_px =
      cv::norm(expected_px, view.image_px) / std::sqrt(static_cast<double>(expected_px.size()));
  if (!std::isfinite(placed.rms_px)) return {};
  return placed;
}

}  // namespace handcast::calib
