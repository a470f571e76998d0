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
  const auto& second = calibration.camera2;
  if (!second)
    return fail(
        Errc::bad_config,
        "the calibration has no second camera ([camera2], [camera2_from_camera]); measure it with "
        "`handcast calibrate`");
  return Views{View{calibration.camera}, View{second->camera, second->from_camera}};
}

}  // namespace handcast::pose::stereo
