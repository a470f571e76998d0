// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"

/// The regions that MediaPipe Hands' landmark network was trained with.
namespace handcast::landmarks {

/// The region around landmarks of the image before, or around the tracker's joints: the box of
/// wrist, thumb, knuckles and middle joints, twice as large (MediaPipe's
/// hand_landmark_landmarks_to_roi).
Region mediapipe_region_of_landmarks(const Points& points_px);

/// The region of a palm: from the centre and the longer side of its box and the line from the wrist
/// to the middle knuckle (MediaPipe's palm_detection_detection_to_roi). All in image pixels.
Region mediapipe_region_of_palm(glm::vec2 centre_px, glm::vec2 extent_px, glm::vec2 wrist_px,
                                glm::vec2 middle_knuckle_px);

}  // namespace handcast::landmarks
