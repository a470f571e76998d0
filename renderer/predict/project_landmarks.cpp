// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/project_landmarks.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

constexpr double kNearest_m = 0.05;

glm::dvec3 in_camera(const calib::Calibration& calibration, const msg::HandPose& pose, int i) {
  const auto& [x, y, z] = pose.joints[msg::kJointOfLandmark[i]].position_m;
  return glm::dvec3(calibration.camera_from_tracker * glm::dvec4(x, y, z, 1));
}

}  // namespace

std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration,
                                                const msg::HandPose& pose) {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::dvec3 place = in_camera(calibration, pose, i);
    if (!(place.z > kNearest_m)) return std::nullopt;
    points[i] = calibration.camera.project(place);
  }
  return points;
}

std::array<float, kLandmarks> landmark_depths_m(const calib::Calibration& calibration,
                                                const msg::HandPose& pose) {
  std::array<float, kLandmarks> depths;
  for (int i = 0; i < kLandmarks; ++i)
    depths[i] = static_cast<float>(std::max(in_camera(calibration, pose, i).z, kNearest_m));
  return depths;
}

}  // namespace handcast::renderer
