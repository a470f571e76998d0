// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration.hpp"

/// The lens: Brown-Conrady distortion, as in "Camera Calibration and 3D Reconstruction" of OpenCV.
namespace handcast::calib {
namespace {

glm::dvec2 to_normalised(const CameraModel& camera, const glm::dvec2& px) {
  return {(px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px};
}

glm::dvec2 to_px(const CameraModel& camera, const glm::dvec2& normalised) {
  return {normalised.x * camera.fx_px + camera.cx_px, normalised.y * camera.fy_px + camera.cy_px};
}

/// The distorted position of a ray, and its derivative by the ray. Both at z = 1, without a unit.
struct Bent {
  glm::dvec2 point;
  glm::dmat2 slope;
};

Bent bend(const CameraModel& c, const glm::dvec2& ray) {
  const double x = ray.x, y = ray.y;
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * c.k3));
  // d radial / d x = radial_slope * x, and likewise for y.
  const double radial_slope = 2 * (c.k1 + r2 * (2 * c.k2 + r2 * 3 * c.k3));

  Bent bent;
  bent.point.x = x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x);
  bent.point.y = y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y;
  const double mixed = x * y * radial_slope + 2 * c.p1 * x + 2 * c.p2 * y;
  bent.slope[0] = {radial + x * x * radial_slope + 2 * c.p1 * y + 6 * c.p2 * x, mixed};
  bent.slope[1] = {mixed, radial + y * y * radial_slope + 6 * c.p1 * y + 2 * c.p2 * x};
  return bent;
}

}  // namespace

glm::dmat3 CameraModel::matrix() const { return {fx_px, 0, 0, 0, fy_px, 0, cx_px, cy_px, 1}; }

glm::dvec2 CameraModel::project(const glm::dvec3& point_m) const {
  return to_px(*this, glm::dvec2(point_m) / point_m.z);
}

glm::dmat3x2 CameraModel::jacobian_px_per_m(const glm::dvec3& point_m) const {
  const double fx = fx_px / point_m.z, fy = fy_px / point_m.z;
  return {glm::dvec2(fx, 0), glm::dvec2(0, fy),
          glm::dvec2(-fx * point_m.x / point_m.z, -fy * point_m.y / point_m.z)};
}

glm::dvec2 CameraModel::distort(const glm::dvec2& undistorted_px) const {
  return to_px(*this, bend(*this, to_normalised(*this, undistorted_px)).point);
}

glm::dvec2 CameraModel::undistort(const glm::dvec2& image_px) const {
  constexpr int kIterations = 8;  // converges quadratically: 3 suffice inside the image
  constexpr double kDone = 1e-24;
  const auto seen = to_normalised(*this, image_px);
  auto ray = seen;
  for (int i = 0; i < kIterations; ++i) {
    const auto bent = bend(*this, ray);
    const auto step = glm::inverse(bent.slope) * (seen - bent.point);
    ray += step;
    if (glm::dot(step, step) < kDone) break;
  }
  return to_px(*this, ray);
}

bool CameraModel::folds() const {
  // Samples along each side of the image, and along the ray from the principal point to each.
  constexpr int kSteps = 16;
  constexpr double kFound_px = 0.01;
  const glm::dvec2 last(width_px - 1, height_px - 1);
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    for (const glm::dvec2 side :
         {glm::dvec2(share, 0), glm::dvec2(share, 1), glm::dvec2(0, share), glm::dvec2(1, share)}) {
      const glm::dvec2 image_px = side * last, px = undistort(image_px);
      if (!(glm::distance(distort(px), image_px) < kFound_px)) return true;
      const auto ray = to_normalised(*this, px);
      for (int step = 1; step <= kSteps; ++step)
        if (!(glm::determinant(bend(*this, ray * (static_cast<double>(step) / kSteps)).slope) > 0))
          return true;
    }
  }
  return false;
}

}  // namespace handcast::calib
