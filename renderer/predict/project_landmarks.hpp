// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// P: the 21 landmarks of a pose (tracker space), projected into the camera. Empty if one of them
/// is behind the camera or less than 5 cm in front of it.
std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration,
                                                const msg::HandPose& pose);

/// The distances of the 21 landmarks of a pose (tracker space) along the camera's axis, at least
/// 5 cm.
std::array<float, kLandmarks> landmark_depths_m(const calib::Calibration& calibration,
                                                const msg::HandPose& pose);

}  // namespace handcast::renderer
