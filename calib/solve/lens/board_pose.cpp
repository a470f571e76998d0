// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/lens/board_pose.hpp"

#include "calib/solve/lens/solve.hpp"

namespace handcast::calib {

std::optional<glm::dmat4> board_pose(const CameraModel& camera, const BoardView& view) {
  constexpr double kMost_px = 3;
  const auto placed = place(points_of(view), camera);
  if (!placed || !(placed->rms_px < kMost_px)) return std::nullopt;
  return matrix_of(placed->pose);
}

}  // namespace handcast::calib
