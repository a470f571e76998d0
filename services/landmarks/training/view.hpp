// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/calibration.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"
#include "services/landmarks/training/pose.hpp"

namespace handcast::landmarks::training {

/// Where the wrist is (camera axes, metres): any side of the hand to the camera, its middle in the
/// camera's sight.
glm::mat4 draw_view(Dice& dice, const renderer::JointFrames& joints);

/// All joints moved by `m`.
renderer::JointFrames moved(const glm::mat4& m, const renderer::JointFrames& joints);

/// Where the camera sees the 21 landmarks' joints.
Points project(const calib::CameraModel& camera, const renderer::JointFrames& in_camera);

/// What a tracker says of this hand: another idea of its size, place and pose; now and then of
/// another pose altogether.
Points draw_tracker(Dice& dice, const calib::CameraModel& camera, const std::vector<Person>& people,
                    const Person& person, const Pose& pose, const renderer::JointFrames& in_camera);

/// The region the detector looks in: around the landmarks of a moment ago, or around what the
/// tracker says.
Region draw_region(Dice& dice, const Points& truth_px, const Points* tracker_px);

}  // namespace handcast::landmarks::training
