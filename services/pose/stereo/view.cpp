// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/view.hpp"

#include <algorithm>

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

}  // namespace handcast::pose::stereo
