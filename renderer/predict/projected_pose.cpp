// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {
namespace {

constexpr double kNearest_m = 0.05;

/// Calls `each(i, place)` with the place of each landmark in camera space, metres. Returns false at
/// the first one that is not in front of the camera.
template <class Each>
bool for_each_in_front(const glm::dmat4& camera_from_tracker, const msg::HandPose& pose,
                       const Each& each) {
  for (int i = 0; i < kLandmarks; ++i) {
    const auto& [x, y, z] = pose.joints[msg::kJointOfLandmark[i]].position_m;
    const glm::dvec3 place(camera_from_tracker * glm::dvec4(x, y, z, 1));
    if (!(place.z > kNearest_m)) return false;
    each(i, place);
  }
  return true;
}

}  // namespace

std::optional<ProjectedPose> project(const calib::Calibration& calibration,
                                     const msg::HandPose& pose) {
  ProjectedPose projected{.pose = pose};
  const bool is_in_front =
      for_each_in_front(calibration.camera_from_tracker, pose, [&](int i, const auto& place) {
        projected.landmarks[i] = calibration.camera.project(place);
        projected.depths_m[i] = place.z;
      });
  return is_in_front ? std::optional(projected) : std::nullopt;
}

std::optional<LandmarkPoints> project_landmarks(const calib::CameraModel& camera,
                                                const glm::dmat4& camera_from_tracker,
                                                const msg::HandPose& pose) {
  LandmarkPoints landmarks;
  const bool is_in_front =
      for_each_in_front(camera_from_tracker, pose,
                        [&](int i, const auto& place) { landmarks[i] = camera.project(place); });
  return is_in_front ? std::optional(landmarks) : std::nullopt;
}

std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration,
                                                const msg::HandPose& pose) {
  return project_landmarks(calibration.camera, calibration.camera_from_tracker, pose);
}

}  // namespace handcast::renderer
