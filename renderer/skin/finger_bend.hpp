// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// The pose (tracker space) with its fingers bent such that their joints are seen nearer to the
/// landmarks. Trackers are most wrong in the flexion of fingers, above all of those that they do
/// not see. A correction in the image puts the joints right, but leaves the skin as the wrong
/// flexion shows it. `landmarks_px`: Q̂ at the time of the pose (undistorted camera px). Each finger
/// moves at three joints, with the prior that the tracker is right; a shift of the whole finger is
/// none of its bends. A finger with a joint that is behind the camera, or with a landmark that is
/// not finite, stays as it is. See `docs/method.md#skin`.
msg::HandPose bent(const msg::HandPose& pose, const LandmarkPoints& landmarks_px,
                   const calib::Calibration& calibration);

}  // namespace handcast::renderer
