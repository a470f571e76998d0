// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/view.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::pose::stereo {

glm::dvec2 View::project(const glm::dvec3& first_m) const {
  glm::dvec3 at_m = in_view(first_m);
  at_m.z = std::max(at_m.z, kNearest_m);
  return camera.project(at_m);
}

Result<Views> views_of(const calib::Calibration& calibration) {
  const auto second = calib::camera_at(calibration, config::Viewpoint::second);
  if (!second) return tl::make_unexpected(second.error());
  return Views{View{calibration.camera}, View{second->model, calibration.camera2->from_camera}};
}

namespace {

constexpr int kTriangulationSteps = 4;
constexpr double kParallel = 1e-9;  ///< least determinant of the sum of two rays' projectors

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The point with the least sum of squared distances from the rays.
std::optional<glm::dvec3> nearest_to_rays(std::span<const Sight> sights) {
  glm::dmat3 sum(0);
  glm::dvec3 right(0);
  for (const Sight& sight : sights) {
    const auto& camera = sight.view->camera;
    const glm::dmat3 first_from_view = glm::transpose(glm::dmat3(sight.view->view_from_first));
    const glm::dvec3 centre_m = -(first_from_view * glm::dvec3(sight.view->view_from_first[3]));
    const glm::dvec3 ray =
        glm::normalize(first_from_view * glm::dvec3((sight.px.x - camera.cx_px) / camera.fx_px,
                                                    (sight.px.y - camera.cy_px) / camera.fy_px, 1));
    const glm::dmat3 across = glm::dmat3(1) - glm::outerProduct(ray, ray);
    sum += across;
    right += across * centre_m;
  }
  if (!(std::abs(glm::determinant(sum)) > kParallel)) return std::nullopt;
  return glm::inverse(sum) * right;
}

/// The problem at a point.
struct Normal {
  glm::dmat3 information{0};
  glm::dvec3 gradient{0};
  double misfit = 0;
};

/// Empty if the point is behind a camera.
std::optional<Normal> normal_at(std::span<const Sight> sights, const glm::dvec3& place_m) {
  Normal normal;
  for (const Sight& sight : sights) {
    const auto& camera = sight.view->camera;
    const glm::dvec3 at_m = sight.view->in_view(place_m);
    if (!(at_m.z > View::kNearest_m)) return std::nullopt;
    const glm::dvec2 miss = (camera.project(at_m) - sight.px) / sight.sigma_px;
    const glm::dmat3x2 slope =
        camera.jacobian_px_per_m(at_m) * glm::dmat3(sight.view->view_from_first) / sight.sigma_px;
    normal.information += glm::transpose(slope) * slope;
    normal.gradient += glm::transpose(slope) * miss;
    normal.misfit += glm::dot(miss, miss);
  }
  return normal;
}

}  // namespace

std::optional<SpacePoint> triangulate(std::span<const Sight> sights) {
  if (sights.size() < 2) return std::nullopt;
  auto place_m = nearest_to_rays(sights);
  if (!place_m || !is_finite(*place_m)) return std::nullopt;
  for (int i = 0; i < kTriangulationSteps; ++i) {
    const auto normal = normal_at(sights, *place_m);
    if (!normal) return std::nullopt;
    *place_m -= glm::inverse(normal->information) * normal->gradient;
  }
  const auto normal = normal_at(sights, *place_m);
  if (!normal || !is_finite(*place_m)) return std::nullopt;
  return SpacePoint{*place_m, glm::inverse(normal->information), normal->misfit};
}

}  // namespace handcast::pose::stereo
