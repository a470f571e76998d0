// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::twin {

/// Draws the hand shape of a person: the length of each finger, the size of the palm and the widths
/// differ from the mean hand by at most the spread of the settings.
renderer::HandShape draw_person(const config::TwinShape& settings, int seed);

/// The hand shape that the joints of a recording have (the left hand if recorded): their medians in
/// the wrist's axes, and the medians of the bones' lengths.
renderer::HandShape recorded_shape(const recording::RecordedHands& recording);

/// The person behind a recorded shape: the lengths of the phalanges are the recorded ones; the palm
/// is the mean person's at the recorded size, because trackers guess its bones; the widths follow
/// its breadth and the seed.
renderer::HandShape person_of(const renderer::HandShape& recorded,
                              const config::TwinShape& settings, int seed);

/// The joints of a second person's hand, open and at rest at the right edge of the image, 0.12 m
/// behind the hands, its forearm leaving the image. Camera axes, metres. It has no tracker and is
/// nobody's truth.
renderer::JointFrames bystander_joints(const renderer::HandMesh& hand,
                                       const calib::CameraModel& camera);

}  // namespace handcast::twin
