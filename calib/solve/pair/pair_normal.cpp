// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_normal.hpp"

#include <opencv2/calib3d.hpp>

namespace handcast::calib {
namespace {

constexpr int kBoard = 6, kLens = 9;
/// Columns of the derivatives.
constexpr int kPairAt = kBoard, kLensAt = kBoard + kPairPose, kAll = kBoard + kShared;

/// The residuals of one image and their derivatives by the pose in this camera and by its lens.
struct Seen {
  cv::Mat1d residuals, by_pose, by_lens;
};

Seen look(const Points& points, const Pose& pose, const CameraModel& camera) {
  std::vector<cv::Point2d> expected_px;
  cv::Mat slopes;
  cv::projectPoints(points.board_m, pose.turn, pose.move, matrix_of(camera), lens_of(camera),
                    expected_px, slopes);
  Seen seen{cv::Mat1d(2 * static_cast<int>(expected_px.size()), 1), slopes.colRange(0, kBoard),
            slopes.colRange(kBoard, kBoard + kLens)};
  auto value = seen.residuals.begin();
  for (std::size_t i = 0; i < expected_px.size(); ++i) {
    *value++ = points.image_px[i].x - expected_px[i].x;
    *value++ = points.image_px[i].y - expected_px[i].y;
  }
  return seen;
}

/// The pose of a board in the second camera, and its derivatives by the two that it is made of.
struct Composed {
  Pose pose;
  cv::Mat1d by_board = cv::Mat1d(kBoard, kBoard), by_pair = cv::Mat1d(kBoard, kBoard);
};

Composed compose(const Pose& board, const Pose& pair) {
  Composed made;
  cv::Mat turn_by_turn1, turn_by_move1, turn_by_turn2, turn_by_move2;
  cv::Mat move_by_turn1, move_by_move1, move_by_turn2, move_by_move2;
  cv::composeRT(board.turn, board.move, pair.turn, pair.move, made.pose.turn, made.pose.move,
                turn_by_turn1, turn_by_move1, turn_by_turn2, turn_by_move2, move_by_turn1,
                move_by_move1, move_by_turn2, move_by_move2);
  const cv::Rect turn_turn(0, 0, 3, 3), turn_move(3, 0, 3, 3), move_turn(0, 3, 3, 3),
      move_move(3, 3, 3, 3);
  turn_by_turn1.copyTo(made.by_board(turn_turn));
  turn_by_move1.copyTo(made.by_board(turn_move));
  move_by_turn1.copyTo(made.by_board(move_turn));
  move_by_move1.copyTo(made.by_board(move_move));
  turn_by_turn2.copyTo(made.by_pair(turn_turn));
  turn_by_move2.copyTo(made.by_pair(turn_move));
  move_by_turn2.copyTo(made.by_pair(move_turn));
  move_by_move2.copyTo(made.by_pair(move_move));
  return made;
}

}  // namespace

Pose seen_by_second(const Pose& board, const Pose& pair) { return compose(board, pair).pose; }

PairNormal normal_of(const PairPoints& view, const Pose& board, const Pose& pair,
                     const Cameras& cameras) {
  const auto there = compose(board, pair);
  const auto first = look(view.first, board, cameras[0]),
             second = look(view.second, there.pose, cameras[1]);
  cv::Mat1d slopes = cv::Mat1d::zeros(first.residuals.rows + second.residuals.rows, kAll);
  auto above = slopes.rowRange(0, first.residuals.rows),
       below = slopes.rowRange(first.residuals.rows, slopes.rows);
  first.by_pose.copyTo(above.colRange(0, kBoard));
  first.by_lens.copyTo(above.colRange(kLensAt, kLensAt + kLens));
  cv::Mat(second.by_pose * there.by_board).copyTo(below.colRange(0, kBoard));
  cv::Mat(second.by_pose * there.by_pair).copyTo(below.colRange(kPairAt, kPairAt + kPairPose));
  second.by_lens.copyTo(below.colRange(kLensAt + kLens, kAll));
  cv::Mat1d residuals, products;
  cv::vconcat(first.residuals, second.residuals, residuals);
  cv::mulTransposed(slopes, products, true);
  const cv::Mat1d slope = slopes.t() * residuals;

  PairNormal normal;
  normal.board = products(cv::Rect(0, 0, kBoard, kBoard));
  normal.mixed = products(cv::Rect(kBoard, 0, kShared, kBoard));
  normal.shared = products(cv::Rect(kBoard, kBoard, kShared, kShared));
  for (int i = 0; i < kBoard; ++i) normal.board_slope[i] = slope(i);
  for (int i = 0; i < kShared; ++i) normal.shared_slope[i] = slope(kBoard + i);
  normal.squares = residuals.dot(residuals);
  return normal;
}

PairStatement statement_of(const PairNormal& normal) {
  const cv::Matx<double, 6, kShared> followed =
      normal.board.solve(normal.mixed, cv::DECOMP_CHOLESKY);
  return {normal.shared - normal.mixed.t() * followed,
          normal.shared_slope - SharedVector(followed.t() * normal.board_slope)};
}

cv::Vec6d board_step(const PairNormal& normal, const cv::Vec6d& pair_step) {
  const cv::Matx66d by_pair = normal.mixed.get_minor<6, 6>(0, 0);
  const cv::Vec6d rest = normal.board_slope - cv::Vec6d(by_pair * pair_step);
  return normal.board.solve(rest, cv::DECOMP_CHOLESKY);
}

}  // namespace handcast::calib
