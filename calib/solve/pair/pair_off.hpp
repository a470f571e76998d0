// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "calib/solve/pair/pair_fit.hpp"

namespace handcast::calib {

/// How wrong the calibration of two cameras is on boards that both see.
struct PairOff {
  double off_line_px = 0;  ///< of a corner from its epipolar line, undistorted px, root mean square
  /// Means of the corners: where both cameras have them, minus where the first camera alone has
  /// them, which knows the size of the board; across and along the ray of the first camera.
  /// @{
  glm::dvec3 across_m{0};
  double along_m = 0;
  /// @}
  double parallax_px = 0;  ///< along_m as the second camera sees it, undistorted px; the same sign
  double depth_m = 0;      ///< mean distance of the corners along the first camera's axis
};

/// Nothing if no corner was seen by both cameras. `second`: the second camera of the calibration.
std::optional<PairOff> pair_off(std::span<const PairView> views, const CameraModel& first,
                                const SecondCamera& second);

/// True if the second camera should see all that the first one sees of a board, by its calibration,
/// and not at the edge of its image. False if the view has no pose.
bool is_whole_in_second(const BoardView& view, const CameraModel& first,
                        const SecondCamera& second);

}  // namespace handcast::calib
