// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "calib/calibration.hpp"
#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// A pose whose board has `centre_m` of camera space at its middle, first turned in its plane by
/// `turn_rad`, then about the x and the y axis of the camera by `tilt_rad`.
inline glm::dmat4 held(const Board& board, glm::dvec3 centre_m, glm::dvec2 tilt_rad,
                       double turn_rad = 0) {
  glm::dmat4 pose = glm::translate(glm::dmat4(1), centre_m);
  pose = glm::rotate(pose, tilt_rad.y, glm::dvec3(0, 1, 0));
  pose = glm::rotate(pose, tilt_rad.x, glm::dvec3(1, 0, 0));
  pose = glm::rotate(pose, turn_rad, glm::dvec3(0, 0, 1));
  const glm::dvec2 middle_m = glm::dvec2(board.columns, board.rows) * board.square_mm * 0.5e-3;
  return glm::translate(pose, glm::dvec3(-middle_m, 0));
}

inline glm::dvec2 seen_px(const CameraModel& camera, const glm::dmat4& camera_from_board,
                          const glm::dvec3& board_m) {
  return camera.distort(camera.project(glm::dvec3(camera_from_board * glm::dvec4(board_m, 1))));
}

}  // namespace handcast::calib
