// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/calibration_file.hpp"

#include "services/camera/leap/controller.hpp"
#include "services/camera/leap/lens_fit.hpp"

namespace handcast::camera::leap {

Result<std::string> calibration_file_from(const std::string& wanted, bool of_right_eye,
                                          int width_px, int height_px) {
  auto controller = open_controller(wanted);
  if (!controller) return tl::make_unexpected(controller.error());
  const auto calibration = read_calibration(controller->device);
  if (!calibration) return tl::make_unexpected(calibration.error());
  return calibration_file_of(*calibration, controller->serial,
                             of_right_eye ? config::Eye::right : config::Eye::left, width_px,
                             height_px);
}

}  // namespace handcast::camera::leap
