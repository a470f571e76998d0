// SPDX-License-Identifier: Apache-2.0
#include "calib/lens/solve.hpp"

#include <cmath>
#include <opencv2/calib3d.hpp>

namespace handcast::calib {
namespace {

/// The flags that keep the coefficients at 0 which a model lacks.
int flags_of(Distortion distortion) {
  int flags = 0;
  if (distortion < Distortion::k1) flags |= cv::CALIB_FIX_K1;
  if (distortion < Distortion::k2) flags |= cv::CALIB_FIX_K2;
  if (distortion < Distortion::tangential) flags |= cv::CALIB_ZERO_TANGENT_DIST;
  if (distortion < Distortion::k3) flags |= cv::CALIB_FIX_K3;
  return flags;
}

/// `start` with the coefficients at 0 that the model lacks.
cv::Vec<double, 5> lens_within(const CameraModel& start, Distortion distortion) {
  auto lens = lens_of(start);
  if (distortion < Distortion::k1) lens[0] = 0;
  if (distortion < Distortion::k2) lens[1] = 0;
  if (distortion < Distortion::tangential) lens[2] = lens[3] = 0;
  if (distortion < Distortion::k3) lens[4] = 0;
  return lens;
}

CameraModel camera_of(const cv::Matx33d& k, const cv::Vec<double, 5>& lens, cv::Size size) {
  return {.width_px = size.width,
          .height_px = size.height,
          .fx_px = k(0, 0),
          .fy_px = k(1, 1),
          .cx_px = k(0, 2),
          .cy_px = k(1, 2),
          .k1 = lens[0],
          .k2 = lens[1],
          .p1 = lens[2],
          .p2 = lens[3],
          .k3 = lens[4]};
}

bool is_sound(const CameraModel& camera) {
  return std::isfinite(camera.k1 + camera.k2 + camera.k3 + camera.p1 + camera.p2) &&
         std::isfinite(camera.cx_px + camera.cy_px) && camera.fx_px > 0 && camera.fy_px > 0;
}

}  // namespace

Points points_of(const BoardView& view) {
  Points points;
  for (const auto& m : view.board_m)
    points.board_m.emplace_back(static_cast<float>(m.x), static_cast<float>(m.y),
                                static_cast<float>(m.z));
  for (const auto& px : view.image_px)
    points.image_px.emplace_back(static_cast<float>(px.x), static_cast<float>(px.y));
  return points;
}

glm::dmat4 matrix_of(const Pose& pose) {
  cv::Matx33d turn;
  cv::Rodrigues(pose.turn, turn);
  glm::dmat4 matrix(1);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix[column][row] = turn(row, column);
    matrix[3][row] = pose.move[row];
  }
  return matrix;
}

cv::Matx33d matrix_of(const CameraModel& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

cv::Vec<double, 5> lens_of(const CameraModel& camera) {
  return {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
}

std::optional<Solution> solve(std::span<const Points> views, Distortion distortion, int width_px,
                              int height_px, const CameraModel* start) {
  std::vector<std::vector<cv::Point3f>> board_m;
  std::vector<std::vector<cv::Point2f>> image_px;
  for (const auto& view : views) {
    board_m.push_back(view.board_m);
    image_px.push_back(view.image_px);
  }
  cv::Mat matrix = cv::Mat::eye(3, 3, CV_64F), lens = cv::Mat::zeros(1, 5, CV_64F);
  int flags = flags_of(distortion);
  if (start) {
    cv::Mat(matrix_of(*start)).copyTo(matrix);
    cv::Mat(lens_within(*start, distortion).t()).copyTo(lens);
    flags |= cv::CALIB_USE_INTRINSIC_GUESS;
  }
  std::vector<cv::Vec3d> turns, moves;
  cv::Mat rms;
  constexpr int kRounds = 60;
  try {
    cv::calibrateCamera(board_m, image_px, {width_px, height_px}, matrix, lens, turns, moves,
                        cv::noArray(), cv::noArray(), rms, flags,
                        {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kRounds, 1e-9});
  } catch (const cv::Exception&) {  // of views that have no solution
    return {};
  }
  Solution solution{camera_of(matrix, lens, {width_px, height_px}), {}, {}};
  if (!is_sound(solution.camera)) return {};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    solution.poses.push_back({turns[i], moves[i]});
    solution.rms_px.push_back(rms.at<double>(static_cast<int>(i)));
  }
  return solution;
}

std::optional<Placed> place(const Points& view, const CameraModel& camera) {
  Placed placed;
  const auto matrix = matrix_of(camera);
  const auto lens = lens_of(camera);
  std::vector<cv::Point2f> expected_px;
  try {
    if (!cv::solvePnP(view.board_m, view.image_px, matrix, lens, placed.pose.turn,
                      placed.pose.move))
      return {};
    cv::projectPoints(view.board_m, placed.pose.turn, placed.pose.move, matrix, lens, expected_px);
  } catch (const cv::Exception&) {  // of points that have no pose
    return {};
  }
  placed.rms_px = cv::norm(expected_px, view.image_px) /
                  std::sqrt(static_cast<double>(expected_px.size()));
  return placed;
}

}  // namespace handcast::calib
