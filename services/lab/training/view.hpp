// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration.hpp"
#include "services/lab/training/pose.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"

namespace handcast::landmarks::training {

/// Draws a position of the wrist in camera axes (metres): any side of the hand faces the camera,
/// its centre is in view.
glm::mat4 draw_view(Dice& dice, const renderer::JointFrames& joints);

/// All joints transformed by `m`.
renderer::JointFrames moved(const glm::mat4& m, const renderer::JointFrames& joints);

/// The joints of the 21 landmarks in camera pixels. `in_camera`: in camera axes (metres).
Points project(const calib::CameraModel& camera, const renderer::JointFrames& in_camera);

/// Draws a tracker's joints for this hand, in camera pixels: with errors in size, position and
/// pose; in one image of five in another pose.
Points draw_tracker(Dice& dice, const calib::CameraModel& camera, const std::vector<Person>& people,
                    const Person& person, const Pose& pose, const renderer::JointFrames& in_camera);

/// Draws the region that a detector would use: around the landmarks of the image before, or around
/// the tracker's joints. `tracker_px`: null if there is no tracker.
Region draw_region(Dice& dice, const Points& truth_px, const Points* tracker_px);

}  // namespace handcast::landmarks::training
