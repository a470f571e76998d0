// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/solve/pair/pair_normal.hpp"

namespace handcast::calib {

/// How far a corner of a board is from where two cameras together have it.
struct CornerError {
  double off_line2_px2 = 0;  ///< squared distance from the epipolar line, mean of both images
  glm::dvec3 place_m{0};     ///< where the first camera alone has it, by the board's size
  glm::dvec3 off_m{0};       ///< where both rays are nearest to each other, minus place_m
};

/// The errors of the corners that both cameras saw. Pixels are undistorted ones, metres those of
/// the first camera. Empty if the first camera's view has no pose.
std::vector<CornerError> corner_errors(const PairPoints& view, const Cameras& cameras,
                                       const glm::dmat4& second_from_first);

}  // namespace handcast::calib
