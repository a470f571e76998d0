// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::renderer {

/// True if the pose can be that of a hand in front of the camera: every number finite, orientations
/// of about unit length, the wrist within 3 m of the camera, every joint within 0.8 m of the wrist
/// (4 hand lengths). Everything behind this check may rely on coordinates of that size.
/// `camera_from_tracker`: rigid, metres.
bool is_plausible(const msg::HandPose& pose, const glm::dmat4& camera_from_tracker);

}  // namespace handcast::renderer
