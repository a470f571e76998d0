// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "calib/solve/pair/pair_normal.hpp"

namespace handcast::calib {

/// The pose of the second camera (second_from_first), and those of the boards in the first one.
struct PairSolution {
  Pose pair;
  std::vector<Pose> boards;
  std::vector<double> rms_px;  ///< of each view, over both images
};

/// The inverse of matrix_of().
Pose pose_of(const glm::dmat4& matrix);

/// The second camera's pose by the single view whose answer suits the others best, in the sense of
/// the median; nothing if no view has one.
std::optional<PairSolution> first_guess(std::span<const PairPoints> views, const Cameras& cameras);

/// The poses that fit best, in the sense of least squares: the minimum that OpenCV's
/// stereoCalibrate finds with fixed intrinsics. `start`: nearly right. Nothing if the views do not
/// determine them.
std::optional<PairSolution> solve(std::span<const PairPoints> views, const Cameras& cameras,
                                  const PairSolution& start);

}  // namespace handcast::calib
