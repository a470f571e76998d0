// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/rig_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "calib/calibration.hpp"
#include "config/second_view.hpp"
#include "services/tools/doctor/display.hpp"

namespace handcast::doctor {
namespace {

/// Of a rig with two cameras, which the calibration has.
Finding second_camera_of(const calib::Calibration& calibration) {
  const auto& camera = calibration.camera;
  const auto& second = *calibration.camera2;
  const auto& made = calibration.made.pair;
  return {"calibration", Grade::good,
          fmt::format("camera {} x {} px, second camera {} x {} px, {:.0f} mm from it ({}), "
                      "projector {} x {} px",
                      camera.width_px, camera.height_px, second.camera.width_px,
                      second.camera.height_px, 1e3 * glm::length(glm::dvec3(second.from_camera[3])),
                      made.empty() ? "it is not said when that was measured"
                                   : "measured " + made.substr(0, made.find(':')),
                      calibration.projector_width_px, calibration.projector_height_px),
          ""};
}

Finding calibration_of(const config::Rig& rig) {
  const bool is_real = rig.camera.backend != "twin" && rig.camera.backend != "replay";
  if (rig.calibration.empty() && is_real)
    return {"calibration", Grade::fault,
            "a real camera with the calibration of the reference rig: the light will miss the hand",
            "make one with `handcast calibrate RIG.toml --camera WxH --projector WxH --apply`"};
  if (rig.calibration.empty())
    return {"calibration", Grade::good, "that of the reference rig, which the twin has", ""};
  const auto calibration = calib::load_calibration(rig.calibration);
  if (!calibration)
    return {"calibration", Grade::fault, calibration.error().what, "`handcast config --check`"};
  const bool has_second = config::has_second_view(rig);
  if (has_second && !calibration->camera2)
    return {"calibration", Grade::fault, "the second camera is not calibrated",
            "`handcast calibrate RIG.toml lens2 pair`"};
  if (is_real && calibration->camera_device.empty())
    return {"calibration", Grade::advice,
            "it does not name its camera, so that another one would not be noticed",
            "set [camera] device in it, as `handcast devices` lists the camera"};
  if (has_second) return second_camera_of(*calibration);
  return {"calibration", Grade::good,
          fmt::format("camera {} x {} px, projector {} x {} px", calibration->camera.width_px,
                      calibration->camera.height_px, calibration->projector_width_px,
                      calibration->projector_height_px),
          ""};
}

}  // namespace

std::vector<Finding> examine_file(const Result<config::Rig>& rig) {
  if (!rig)
    return {{"rig file", Grade::fault, rig.error().what,
             "`handcast config --reference` explains all settings"}};
  std::vector<Finding> findings{{"rig file", Grade::good, fmt::format("rig '{}'", rig->name), ""},
                                calibration_of(*rig)};
  if (const auto calibration = calib::load_calibration(rig->calibration))
    for (auto& finding : examine_display(*rig, *calibration))
      findings.push_back(std::move(finding));
  return findings;
}

}  // namespace handcast::doctor
