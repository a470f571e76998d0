// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// P: where the camera sees the 21 landmarks of a pose in tracker space (undistorted camera px).
/// Empty if one of them is behind the camera or nearer than 5 cm.
std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration,
                                                const msg::HandPose& pose);

}  // namespace handcast::renderer
