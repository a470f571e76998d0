// SPDX-License-Identifier: Apache-2.0
#include "calib/pair/pair_off.hpp"

#include <algorithm>
#include <cmath>

#include "calib/lens/board_pose.hpp"
#include "calib/pair/corner_error.hpp"

namespace handcast::calib {

std::optional<PairOff> pair_off(std::span<const PairView> views, const CameraModel& first,
                                const SecondCamera& second) {
  PairOff off;
  double squares_px2 = 0, corners = 0;
  for (const auto& view : views)
    for (const auto& error : corner_errors({points_of(view.first), points_of(view.second)},
                                           {first, second.camera}, second.from_camera)) {
      squares_px2 += error.off_line2_px2;
      off.off_m += error.off_m;
      off.depth_m += error.place_m.z;
      ++corners;
    }
  if (corners == 0) return std::nullopt;
  off.off_line_px = std::sqrt(squares_px2 / corners);
  off.off_m /= corners;
  off.depth_m /= corners;
  return off;
}

double share_in_second(const BoardView& view, const CameraModel& first,
                       const SecondCamera& second) {
  const auto first_from_board = board_pose(first, view);
  if (!first_from_board) return 0;
  const auto second_from_board = second.from_camera * *first_from_board;
  const auto inside = std::ranges::count_if(view.board_m, [&](const glm::dvec3& m) {
    const glm::dvec3 at_m(second_from_board * glm::dvec4(m, 1));
    if (!(at_m.z > 0)) return false;
    const auto px = second.camera.distort(second.camera.project(at_m));
    return px.x >= 0 && px.y >= 0 && px.x < second.camera.width_px &&
           px.y < second.camera.height_px;
  });
  return static_cast<double>(inside) / static_cast<double>(view.board_m.size());
}

}  // namespace handcast::calib
