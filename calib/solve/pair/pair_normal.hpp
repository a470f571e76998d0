// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/solve/lens/normal.hpp"

namespace handcast::calib {

/// The points of a board in both images.
struct PairPoints {
  Points first, second;
};
using Cameras = std::array<CameraModel, 2>;

/// The parameters that all views share: pose of the second camera (rotation vector, translation;
/// second_from_first), and kLensParameters of both cameras.
constexpr int kShared = kPoseNumbers + 2 * kLensNumbers;

/// The equations of the squared distances of one view: the pose of the board in the first camera,
/// then the first `shared` of the shared parameters.
NormalEquations normal_of(const PairPoints& view, const Pose& board, const Pose& pair,
                          const Cameras& cameras, int shared);

/// The pose of a board in the second camera.
Pose seen_by_second(const Pose& board, const Pose& pair);

}  // namespace handcast::calib
