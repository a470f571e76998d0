// SPDX-License-Identifier: Apache-2.0
#include "calib/projector_model.hpp"

#include "calib/calibration.hpp"

namespace handcast::calib {

glm::dvec2 mapped(const glm::dmat3& homography, const glm::dvec2& px) {
  const auto point = homography * glm::dvec3(px, 1);
  return glm::dvec2(point) / point.z;
}

glm::dvec2 ProjectorModel::pixel_of(const glm::dvec2& camera_px) const {
  return mapped(from_camera, camera_px);
}

glm::dvec2 ProjectorModel::pixel_of(const glm::dvec2& camera_px, double depth_m) const {
  return mapped(homography_at(depth_m), camera_px);
}

glm::dvec2 ProjectorModel::camera_pixel_of(const glm::dvec2& projector_px) const {
  return mapped(glm::inverse(from_camera), projector_px);
}

/// The parallax is the same for all pixels, so it is part of the column that multiplies 1.
glm::dmat3 ProjectorModel::homography_at(double depth_m) const {
  auto homography = from_camera;
  homography[2] += parallax * (1 / depth_m - 1 / plane_m);
  return homography;
}

ProjectorModel ProjectorModel::moved(const glm::dmat3& pixels) const {
  auto other = *this;
  other.from_camera = pixels * from_camera;
  other.parallax = pixels * parallax;
  return other;
}

ProjectorModel ProjectorModel::normalised() const {
  const double scale = 1 / from_camera[2][2];
  auto same = *this;
  same.from_camera = from_camera * scale;
  same.parallax = parallax * scale;
  return same;
}

/// The projection matrix is (A | parallax), where A K^-1 is the homography of the plane at
/// infinity; the centre is the point that it maps to 0.
glm::dvec3 ProjectorModel::centre_m(const CameraModel& camera) const {
  auto infinite = from_camera;
  infinite[2] -= parallax / plane_m;
  return -glm::inverse(infinite * camera.matrix()) * parallax;
}

}  // namespace handcast::calib
