// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "calib/solve/pair/pair_solve.hpp"

namespace handcast::calib {

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
