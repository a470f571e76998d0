// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "calib/solve/lens/lens_fit.hpp"

namespace handcast::calib {

/// The points of a view as OpenCV takes them.
struct Points {
  std::vector<cv::Point3d> board_m;
  std::vector<cv::Point2d> image_px;
};
Points points_of(const BoardView& view);

/// A board's pose: rotation vector, and translation in metres.
struct Pose {
  cv::Vec3d turn, move;
};
glm::dmat4 matrix_of(const Pose& pose);

/// A camera and the poses of the boards that it was solved from.
struct Solution {
  CameraModel camera;
  std::vector<Pose> poses;
  std::vector<double> rms_px;  ///< of each view
};

/// A camera without distortion, by Zhang's closed form, and the poses of the boards as it sees
/// them; nothing if the views do not determine them.
std::optional<Solution> first_guess(std::span<const Points> views, int width_px, int height_px);

/// The camera and the poses that fit best, in the sense of least squares: the minimum that OpenCV's
/// calibrateCamera finds. `start`: nearly right. Nothing if the views do not determine the camera.
std::optional<Solution> solve(std::span<const Points> views, Distortion distortion,
                              const Solution& start);

/// The pose of one board, and how far its corners then are from where they were seen.
struct Placed {
  Pose pose;
  double rms_px = 0;
};
std::optional<Placed> place(const Points& view, const CameraModel& camera);

/// K, and k1 k2 p1 p2 k3 in OpenCV's order.
/// @{
cv::Matx33d matrix_of(const CameraModel& camera);
cv::Vec<double, 5> lens_of(const CameraModel& camera);
/// @}

}  // namespace handcast::calib
