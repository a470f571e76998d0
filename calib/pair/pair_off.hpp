// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "calib/pair/pair_fit.hpp"

namespace handcast::calib {

/// How wrong the calibration of two cameras is on boards that both see.
struct PairOff {
  double off_line_px = 0;  ///< of a corner from its epipolar line, undistorted px, root mean square
  /// Mean of the corners: where both cameras have them, minus where the first camera alone has
  /// them, which knows the size of the board.
  glm::dvec3 off_m{0};
  double depth_m = 0;  ///< mean distance of the corners along the first camera's axis
};

/// Nothing if no corner was seen by both cameras. `second`: the second camera of the calibration.
std::optional<PairOff> pair_off(std::span<const PairView> views, const CameraModel& first,
                                const SecondCamera& second);

/// The share of a board's points that the second camera should see, by its calibration, while the
/// first one sees them so; 0 if the view has no pose.
double share_in_second(const BoardView& view, const CameraModel& first, const SecondCamera& second);

}  // namespace handcast::calib
