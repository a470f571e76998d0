// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/true_geometry.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "services/lab/twin/random.hpp"

namespace handcast::twin {
namespace {

constexpr double kVolume_m = 0.73;  ///< distance of the middle of the working volume

glm::dvec3 direction(const Random& random, std::uint64_t draw) {
  return glm::normalize(
      glm::dvec3(random.normal(draw), random.normal(draw + 1), random.normal(draw + 2)));
}

/// Moves the corners of the projector's image by `rms_px` per corner.
glm::dmat3 corner_error(const calib::ProjectorModel& projector, double rms_px, const Random& random,
                        std::uint64_t draw) {
  const double w = projector.width_px, h = projector.height_px;
  const std::array<glm::dvec2, 4> corners{{{0, 0}, {w, 0}, {w, h}, {0, h}}};
  auto moved = corners;
  for (std::uint64_t i = 0; i < 4; ++i)
    moved[i] += rms_px / std::numbers::sqrt2 *
                glm::dvec2(random.normal(draw + 2 * i), random.normal(draw + 2 * i + 1));
  return homography(corners, moved);
}

/// The projector as it is. `draw`: the first of the random numbers; 11 are used.
calib::ProjectorModel true_projector(const config::TwinGeometry& settings,
                                     const calib::CameraModel& camera,
                                     calib::ProjectorModel projector, const Random& random,
                                     std::uint64_t draw) {
  const double angle = std::numbers::pi * random.spread(draw + 10);
  const auto centre_m =
      settings.projector_offset_mm * 1e-3 * glm::dvec3(std::cos(angle), std::sin(angle), 0);
  projector.plane_m += settings.plane_mm * 1e-3;
  if (settings.homography_px > 0)
    projector.from_camera =
        corner_error(projector, settings.homography_px, random, draw) * projector.from_camera;
  projector.parallax -= projector.from_camera * (camera.matrix() * centre_m);
  return projector;
}

/// Turns about the middle of the working volume and shifts, in camera space.
glm::dmat4 pose_error(const config::TwinGeometry& settings, const Random& random) {
  const glm::dvec3 middle(0, 0, kVolume_m);
  const auto turn =
      glm::rotate(glm::dmat4(1), glm::radians(settings.tracker_deg), direction(random, 20));
  const auto shift = direction(random, 30) * settings.tracker_mm * 1e-3;
  return glm::translate(glm::dmat4(1), middle + shift) * turn *
         glm::translate(glm::dmat4(1), -middle);
}

/// A change of k1 that moves the corners of the image by `corner_px`.
double lens_error(const calib::CameraModel& camera, double corner_px, const Random& random) {
  const double radius = std::hypot(camera.cx_px / camera.fx_px, camera.cy_px / camera.fy_px);
  return corner_px / camera.fx_px / std::pow(radius, 3) * (random.uniform(40) < 0.5 ? -1 : 1);
}

}  // namespace

TrueGeometry::TrueGeometry(const config::TwinGeometry& settings, int seed,
                           const calib::Calibration& base, const calib::CameraModel& believed)
    : true_(base), believed_(believed) {
  const Random random(seed, Stream::geometry);
  constexpr std::uint64_t kOfSecond = 50;  // a second projector has errors of its own
  true_.projector = true_projector(settings, true_.camera, base.projector, random, 0);
  if (base.projector2)
    true_.projector2->model =
        true_projector(settings, true_.camera, base.projector2->model, random, kOfSecond);
  if (settings.tracker_mm > 0 || settings.tracker_deg > 0)
    true_.camera_from_tracker = pose_error(settings, random) * base.camera_from_tracker;
  if (settings.lens_px > 0) true_.camera.k1 += lens_error(base.camera, settings.lens_px, random);
}

glm::dvec2 TrueGeometry::to_projector(const glm::dvec3& camera_m) const {
  return true_.projector.pixel_of(true_.camera.project(camera_m), camera_m.z);
}

}  // namespace handcast::twin
