// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/depth_error.hpp"

#include <algorithm>

#include "ipc/base/statistics.hpp"

namespace handcast::calib {

ErrorVolume error_volume(const ProjectorModel& believed, const ProjectorModel& truth,
                         const CameraModel& camera, std::span<const double> depths_m, int columns,
                         int rows) {
  ErrorVolume volume{columns, rows, {depths_m.begin(), depths_m.end()}, {}};
  const glm::dvec2 last(camera.width_px - 1, camera.height_px - 1);
  for (const double depth_m : depths_m)
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const auto px = last * glm::dvec2(column, row) / glm::dvec2(columns - 1, rows - 1);
        volume.error_px.push_back(
            glm::distance(believed.pixel_of(px, depth_m), truth.pixel_of(px, depth_m)));
      }
  return volume;
}

ErrorVolume coaxial_error(const ProjectorModel& model, const CameraModel& camera,
                          std::span<const double> depths_m, int columns, int rows) {
  return error_volume({model.from_camera, glm::dvec3(0), model.plane_m}, model, camera, depths_m,
                      columns, rows);
}

std::vector<DepthError> depth_error(const ProjectorModel& believed, const ProjectorModel& truth,
                                    const CameraModel& camera, std::span<const double> depths_m) {
  std::vector<DepthError> errors;
  for (const double depth_m : depths_m) {
    const auto at = error_volume(believed, truth, camera, {&depth_m, 1}).error_px;
    errors.push_back({depth_m, median(at), std::ranges::max(at)});
  }
  return errors;
}

}  // namespace handcast::calib
