// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_solve.hpp"

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "calib/least_squares/levenberg_marquardt.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

PartEquations equations_at(std::span<const PairPoints> views, const Cameras& cameras,
                           const PairSolution& at) {
  PartEquations equations{.own = kPoseNumbers};
  for (std::size_t i = 0; i < views.size(); ++i)
    equations.add(normal_of(views[i], at.boards[i], at.pair, cameras, kPoseNumbers));
  return equations;
}

PairSolution moved(PairSolution solution, const PartEquations::Step& step) {
  move(solution.pair, step.shared);
  for (std::size_t i = 0; i < solution.boards.size(); ++i) move(solution.boards[i], step.own[i]);
  return solution;
}

double points_in(const PairPoints& view) {
  return static_cast<double>(view.first.image_px.size() + view.second.image_px.size());
}

double rms_in_second_px(const PairPoints& view, const Pose& board, const Pose& pair,
                        const CameraModel& camera) {
  std::vector<cv::Point2d> expected_px;
  const auto there = seen_by_second(board, pair);
  cv::projectPoints(view.second.board_m, there.turn, there.move, matrix_of(camera), lens_of(camera),
                    expected_px);
  return cv::norm(expected_px, view.second.image_px) /
         std::sqrt(static_cast<double>(expected_px.size()));
}

}  // namespace

Pose pose_of(const glm::dmat4& matrix) {
  cv::Matx33d turn;
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) turn(row, column) = matrix[column][row];
    pose.move[row] = matrix[3][row];
  }
  cv::Rodrigues(turn, pose.turn);
  return pose;
}

std::optional<PairSolution> first_guess(std::span<const PairPoints> views, const Cameras& cameras) {
  PairSolution guess;
  std::vector<Pose> candidates;
  for (const auto& view : views) {
    const auto here = place(view.first, cameras[0]), there = place(view.second, cameras[1]);
    if (!here || !there) return {};
    guess.boards.push_back(here->pose);
    candidates.push_back(pose_of(matrix_of(there->pose) * glm::inverse(matrix_of(here->pose))));
  }
  double least_px = std::numeric_limits<double>::infinity();
  for (const auto& candidate : candidates) {
    std::vector<double> rms_px;
    for (std::size_t i = 0; i < views.size(); ++i)
      rms_px.push_back(rms_in_second_px(views[i], guess.boards[i], candidate, cameras[1]));
    const double middle_px = median(rms_px);
    if (!(middle_px < least_px)) continue;
    least_px = middle_px;
    guess.pair = candidate;
    guess.rms_px = std::move(rms_px);
  }
  return std::isfinite(least_px) ? std::optional(guess) : std::nullopt;
}

std::optional<PairSolution> solve(std::span<const PairPoints> views, const Cameras& cameras,
                                  const PairSolution& start) {
  constexpr Effort kEffort{60, 1e-9};
  PairSolution best = start;
  const auto equations = minimise(
      best, kEffort, [&](const PairSolution& at) { return equations_at(views, cameras, at); },
      moved);
  if (!std::isfinite(equations.cost)) return {};
  best.rms_px.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    best.rms_px[i] = std::sqrt(equations.parts[i].cost / points_in(views[i]));
  return best;
}

}  // namespace handcast::calib
