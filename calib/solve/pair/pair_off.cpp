// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/pair_off.hpp"

#include <algorithm>
#include <cmath>

#include "calib/solve/lens/board_pose.hpp"
#include "calib/solve/pair/corner_error.hpp"

namespace handcast::calib {
namespace {

/// How far a point moves in the second camera's image per metre along a ray of the first camera.
double px_per_m(const glm::dvec3& place_m, const glm::dvec3& ray, const SecondCamera& second) {
  const glm::dvec3 point_m(second.from_camera * glm::dvec4(place_m, 1));
  const auto step = glm::dmat3(second.from_camera) * ray;
  const auto slope = (glm::dvec2(step) - step.z / point_m.z * glm::dvec2(point_m)) / point_m.z;
  return std::hypot(second.camera.fx_px * slope.x, second.camera.fy_px * slope.y);
}

/// A lens bends points far outside its image back into it.
bool is_well_inside(const CameraModel& camera, const glm::dvec2& undistorted_px) {
  constexpr double kEdge = 0.05;  ///< of the width
  constexpr double kSame_px = 1;
  const auto px = camera.distort(undistorted_px);
  const double edge_px = kEdge * camera.width_px;
  return px.x >= edge_px && px.y >= edge_px && px.x <= camera.width_px - 1 - edge_px &&
         px.y <= camera.height_px - 1 - edge_px &&
         glm::distance(camera.undistort(px), undistorted_px) < kSame_px;
}

}  // namespace

std::optional<PairOff> pair_off(std::span<const PairView> views, const CameraModel& first,
                                const SecondCamera& second) {
  PairOff off;
  double squares_px2 = 0, corners = 0;
  for (const auto& view : views)
    for (const auto& error : corner_errors({points_of(view.first), points_of(view.second)},
                                           {first, second.camera}, second.from_camera)) {
      squares_px2 += error.off_line2_px2;
      const auto ray = glm::normalize(error.place_m);
      const double along_m = glm::dot(error.off_m, ray);
      off.along_m += along_m;
      off.across_m += error.off_m - along_m * ray;
      off.parallax_px += along_m * px_per_m(error.place_m, ray, second);
      off.depth_m += error.place_m.z;
      ++corners;
    }
  if (corners == 0) return std::nullopt;
  off.off_line_px = std::sqrt(squares_px2 / corners);
  off.across_m /= corners;
  off.along_m /= corners;
  off.parallax_px /= corners;
  off.depth_m /= corners;
  return off;
}

bool is_whole_in_second(const BoardView& view, const CameraModel& first,
                        const SecondCamera& second) {
  const auto first_from_board = board_pose(first, view);
  if (!first_from_board) return false;
  const auto second_from_board = second.from_camera * *first_from_board;
  return std::ranges::all_of(view.board_m, [&](const glm::dvec3& m) {
    const glm::dvec3 at_m(second_from_board * glm::dvec4(m, 1));
    return at_m.z > 0 && is_well_inside(second.camera, second.camera.project(at_m));
  });
}

}  // namespace handcast::calib
