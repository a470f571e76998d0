// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <opencv2/core.hpp>

#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {

/// The points of a board in both images.
struct PairPoints {
  Points first, second;
};
using Cameras = std::array<CameraModel, 2>;

/// The parameters that all views share: pose of the second camera (rotation vector, translation;
/// second_from_first), and kLensParameters of both cameras.
constexpr int kShared = 24;
constexpr int kPairPose = 6;
using SharedMatrix = cv::Matx<double, kShared, kShared>;
using SharedVector = cv::Vec<double, kShared>;

/// The part of the second camera's pose.
inline cv::Vec6d pair_part(const SharedVector& shared) {
  return {shared[0], shared[1], shared[2], shared[3], shared[4], shared[5]};
}

/// The normal equations of the squared distances of one view: how they change with the pose of the
/// board in the first camera (rotation vector, translation) and with the shared parameters.
struct PairNormal {
  cv::Matx66d board;
  cv::Matx<double, 6, kShared> mixed;
  SharedMatrix shared;
  cv::Vec6d board_slope;  ///< the transposed derivative times the residuals
  SharedVector shared_slope;
  double squares = 0;  ///< the sum of the squared distances
};
PairNormal normal_of(const PairPoints& view, const Pose& board, const Pose& pair,
                     const Cameras& cameras);

/// What a view says about the shared parameters alone, after its board is eliminated (Schur
/// complement).
struct PairStatement {
  SharedMatrix matrix;
  SharedVector slope;
};
PairStatement statement_of(const PairNormal& normal);

/// The step of the board that goes with a step of the second camera's pose.
cv::Vec6d board_step(const PairNormal& normal, const cv::Vec6d& pair_step);

/// The pose of a board in the second camera.
Pose seen_by_second(const Pose& board, const Pose& pair);

}  // namespace handcast::calib
