// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "calib/solve/pair/pair_normal.hpp"
#include "calib/solve/pair/pair_solve.hpp"

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

/// How wrong a pair of cameras is on views that its fit has not seen, root mean squares.
struct PairError {
  double epipolar_px = 0;  ///< from the epipolar line, undistorted px
  double place_mm = 0;     ///< from the corners of the board as the first camera has it
};

/// Predicts each view by a fit of the others, without one part of five. Corners that only one
/// camera saw do not count. Nothing if a part has no fit, or no corner was seen by both.
std::optional<PairError> held_out(std::span<const PairPoints> views, const Cameras& cameras,
                                  const PairSolution& solution);

}  // namespace handcast::calib
