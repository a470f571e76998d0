// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/project_landmarks.hpp"

namespace handcast::renderer {
namespace {

constexpr double kNearest_m = 0.05;

}  // namespace

std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration,
                                                const msg::HandPose& pose) {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) {
    const auto& [x, y, z] = pose.joints[msg::kJointOfLandmark[i]].position_m;
    const glm::dvec3 in_camera =
        glm::dvec3(calibration.camera_from_tracker * glm::dvec4(x, y, z, 1));
    if (!(in_camera.z > kNearest_m)) return std::nullopt;
    points[i] = calibration.camera.project(in_camera);
  }
  return points;
}

}  // namespace handcast::renderer
