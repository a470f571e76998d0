// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "calib/calibration.hpp"
#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// Where a board is, by a lens that is known: camera_from_board, rigid, metres. Empty if the points
/// do not determine it, or are more than 3 px (root mean square) from where it would have them.
std::optional<glm::dmat4> board_pose(const CameraModel& camera, const BoardView& view);

}  // namespace handcast::calib
