// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::twin {

/// The joints of a second person's hand, open and at rest at the right edge of the image, 0.12 m
/// behind the hands, its forearm leaving the image. Camera axes, metres. It has no tracker and is
/// nobody's truth.
renderer::JointFrames bystander_joints(const renderer::HandMesh& hand,
                                       const calib::CameraModel& camera);

}  // namespace handcast::twin
