// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/screen_model.hpp"

namespace handcast::calib {

glm::dvec2 mapped(const glm::dmat3& homography, const glm::dvec2& px) {
  const auto point = homography * glm::dvec3(px, 1);
  return glm::dvec2(point) / point.z;
}

glm::dvec2 ScreenModel::to_projector(const glm::dvec2& undistorted_px, double depth_m) const {
  const auto point = projector_from_camera * glm::dvec3(undistorted_px, 1) +
                     parallax * (1 / depth_m - 1 / plane_m);
  return glm::dvec2(point) / point.z;
}

/// The parallax is the same for all pixels, so it is part of the column that multiplies 1.
glm::dmat3 ScreenModel::homography_at(double depth_m) const {
  auto homography = projector_from_camera;
  homography[2] += parallax * (1 / depth_m - 1 / plane_m);
  return homography / homography[2][2];
}

ScreenModel ScreenModel::normalised() const {
  const double scale = 1 / projector_from_camera[2][2];
  return {projector_from_camera * scale, parallax * scale, plane_m};
}

/// The projection matrix is (A | parallax), where A K^-1 is the homography of the plane at
/// infinity; the centre is the point that it maps to 0.
glm::dvec3 ScreenModel::projector_centre_m(const CameraModel& camera) const {
  auto infinite = projector_from_camera;
  infinite[2] -= parallax / plane_m;
  return -glm::inverse(infinite * camera.matrix()) * parallax;
}

}  // namespace handcast::calib
