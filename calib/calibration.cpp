// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <limits>
#include <utility>

#include "calib/rigid.hpp"

namespace handcast::calib {
namespace {

glm::dmat3 translation(double x, double y) { return {1, 0, 0, 0, 1, 0, x, y, 1}; }

/// A homography for the reference rig, since the authors of the paper published none. It maps the
/// camera image onto the projector image as in a coaxial rig that was aligned by hand: turned by
/// 0.4 degrees, with a keystone of about one pixel in the corners.
glm::dmat3 coaxial_homography(const CameraModel& camera, int width_px, int height_px) {
  const double angle = glm::radians(0.4);
  const double scale = static_cast<double>(width_px) / camera.width_px;
  const double cosine = scale * std::cos(angle), sine = scale * std::sin(angle);
  const glm::dmat3 turn(cosine, sine, 0, -sine, cosine, 0, 0, 0, 1);
  const glm::dmat3 keystone(1, 0, 4e-6, 0, 1, -3e-6, 0, 0, 1);
  const auto to_centre = translation(-(camera.width_px - 1) / 2.0, -(camera.height_px - 1) / 2.0);
  return translation((width_px - 1) / 2.0, (height_px - 1) / 2.0) * turn * keystone * to_centre;
}

}  // namespace

glm::dmat4 orthonormalised(const glm::dmat4& transform) {
  const auto x = glm::normalize(glm::dvec3(transform[0]));
  const auto y =
      glm::normalize(glm::dvec3(transform[1]) - glm::dot(glm::dvec3(transform[1]), x) * x);
  return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(glm::cross(x, y), 0), transform[3]};
}

double distance_from_rigid(const glm::dmat4& transform) {
  const auto nearest = orthonormalised(transform);
  double distance = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      const double off = std::abs(nearest[column][row] - transform[column][row]);
      if (std::isnan(off)) return std::numeric_limits<double>::infinity();
      distance = std::max(distance, off);
    }
  return distance;
}

glm::dmat4x3 Calibration::projection() const {
  auto from_ray = projector.from_camera * camera.matrix();
  from_ray[2] -= projector.parallax / projector.plane_m;
  // What the camera sees in the middle is before the projector.
  const double before = (projector.from_camera * glm::dvec3(camera.cx_px, camera.cy_px, 1)).z;
  const double scale = std::copysign(1 / glm::length(glm::row(from_ray, 2)), before);
  return {scale * from_ray[0], scale * from_ray[1], scale * from_ray[2],
          scale * projector.parallax};
}

double Calibration::degrees_apart() const {
  const glm::dvec3 hand_m = projector.plane_m * (glm::inverse(camera.matrix()) *
                                                 glm::dvec3((camera.width_px - 1) / 2.0,
                                                            (camera.height_px - 1) / 2.0, 1));
  const auto to_projector = glm::normalize(projector.centre_m(camera) - hand_m);
  return glm::degrees(std::acos(std::min(1.0, glm::dot(to_projector, -glm::normalize(hand_m)))));
}

double Calibration::mm_per_projector_px(double distance_m) const {
  const glm::dvec2 centre((projector.width_px - 1) / 2.0, (projector.height_px - 1) / 2.0);
  const auto here = projector.camera_pixel_of(centre);
  const auto right = projector.camera_pixel_of(centre + glm::dvec2(1, 0)) - here,
             down = projector.camera_pixel_of(centre + glm::dvec2(0, 1)) - here;
  // Area of one projector pixel in the camera image.
  const double area_px2 = std::abs(right.x * down.y - right.y * down.x);
  return 1000 * distance_m * std::sqrt(area_px2 / (camera.fx_px * camera.fy_px));
}

PlacedCamera first_camera(const Calibration& calibration) {
  return {calibration.camera_device, calibration.camera, calibration.camera_from_tracker};
}

Result<PlacedCamera> camera_at(const Calibration& calibration, config::Viewpoint at) {
  if (at == config::Viewpoint::first) return first_camera(calibration);
  const auto& second = calibration.camera2;
  if (!second)
    return fail(
        Errc::bad_config,
        "the calibration has no second camera ([camera2], [camera2_from_camera]); measure it with "
        "`handcast calibrate`");
  return PlacedCamera{second->device, second->camera,
                      second->from_camera * calibration.camera_from_tracker};
}

Calibration at_projector(Calibration calibration, config::Viewpoint at) {
  if (at == config::Viewpoint::first) return calibration;
  std::swap(calibration.projector_device, calibration.projector2->device);
  std::swap(calibration.projector, calibration.projector2->model);
  return calibration;
}

Calibration reference_rig() {
  Calibration rig;
  rig.camera.k1 = -0.28190479;
  rig.camera.k2 = -0.09617811;
  rig.camera.p1 = 0.00165304;
  rig.camera.p2 = 0.0000942112;
  rig.camera.k3 = 1.63144417;
  // Columns: the axes of the tracker in camera space, and its origin in metres.
  rig.camera_from_tracker =
      orthonormalised({-0.9820147752761841, 0.14056652784347534, -0.1260479986667633, 0,  //
                       -0.01631111092865467, 0.6019535064697266, 0.7983646988868713, 0,   //
                       0.18809837102890015, 0.7860618829727173, -0.5888343453407288, 0,   //
                       -0.1351909637451172, -0.2582590026855469, 0.3932641906738281, 1});
  rig.projector.from_camera =
      coaxial_homography(rig.camera, rig.projector.width_px, rig.projector.height_px);
  return rig;
}

}  // namespace handcast::calib
