// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// A pose and where the camera sees its landmarks.
struct ProjectedPose {
  msg::HandPose pose;                         ///< tracker space
  LandmarkPoints landmarks{};                 ///< P: undistorted camera px
  std::array<double, kLandmarks> depths_m{};  ///< of the landmarks, along the camera's axis
};

/// Projects the landmarks of a pose (tracker space) into the camera. Empty if one of them is behind
/// the camera or less than 5 cm in front of it.
std::optional<ProjectedPose> project(const calib::Calibration& calibration,
                                     const msg::HandPose& pose);
/// P alone, of any camera: its lens, and its pose as the transform from tracker space.
std::optional<LandmarkPoints> project_landmarks(const calib::CameraModel& camera,
                                                const glm::dmat4& camera_from_tracker,
                                                const msg::HandPose& pose);
/// P alone.
std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration,
                                                const msg::HandPose& pose);

}  // namespace handcast::renderer
