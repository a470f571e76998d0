// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_normal.hpp"

#include <opencv2/calib3d.hpp>

namespace handcast::calib {
namespace {

/// The pose of a board in the second camera, and its derivatives by the two that it is made of.
struct Composed {
  Pose pose;
  Eigen::Matrix<double, kPoseNumbers, kPoseNumbers> by_board, by_pair;
};

Composed compose(const Pose& board, const Pose& pair) {
  Composed made;
  std::array<cv::Mat1d, 8> by;  // of turn and move, by turn and move of the board and of the pair
  cv::composeRT(board.turn, board.move, pair.turn, pair.move, made.pose.turn, made.pose.move, by[0],
                by[1], by[2], by[3], by[4], by[5], by[6], by[7]);
  const auto block = [&](std::size_t i) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(by[i].ptr<double>());
  };
  made.by_board << block(0), block(1), block(4), block(5);
  made.by_pair << block(2), block(3), block(6), block(7);
  return made;
}

}  // namespace

Pose seen_by_second(const Pose& board, const Pose& pair) { return compose(board, pair).pose; }

NormalEquations normal_of(const PairPoints& view, const Pose& board, const Pose& pair,
                          const Cameras& cameras, int shared) {
  constexpr int kLensAt = 2 * kPoseNumbers;
  const auto there = compose(board, pair);
  const auto first = seen_of(view.first, board, cameras[0]),
             second = seen_of(view.second, there.pose, cameras[1]);
  const auto above = first.residuals.size(), below = second.residuals.size();
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(above + below, kPoseNumbers + kShared);
  jacobian.topLeftCorner(above, kPoseNumbers) = first.by_pose;
  jacobian.block(0, kLensAt, above, kLensNumbers) = first.by_lens;
  jacobian.bottomLeftCorner(below, kPoseNumbers) = second.by_pose * there.by_board;
  jacobian.block(above, kPoseNumbers, below, kPoseNumbers) = second.by_pose * there.by_pair;
  jacobian.bottomRightCorner(below, kLensNumbers) = second.by_lens;
  Eigen::VectorXd residuals(above + below);
  residuals << first.residuals, second.residuals;
  return NormalEquations::of(jacobian.leftCols(kPoseNumbers + shared), residuals);
}

}  // namespace handcast::calib
