// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "ipc/msg/landmarks.hpp"

namespace handcast::landmarks {

/// 21 points in pixels, MediaPipe's order; (0,0) is the centre of the top-left pixel.
using Points = std::array<glm::vec2, msg::kLandmarks>;

/// Clockwise as seen in the image.
glm::vec2 turned(glm::vec2 v, float angle_rad);

/// A square of the image, turned so that the hand in it points up. What a network is shown.
struct Region {
  glm::vec2 centre_px{0};
  float size_px = 0;    ///< length of a side
  float angle_rad = 0;  ///< clockwise as seen in the image; 0: up is up

  /// `place` is -0.5..0.5 from the left to the right and from the upper to the lower edge.
  glm::vec2 to_image(glm::vec2 place) const;
  glm::vec2 to_place(glm::vec2 image_px) const;
};

/// The whole image in a square, its longer side from edge to edge.
Region region_of_image(int width_px, int height_px);

/// Around landmarks seen a moment ago, or the tracker's joints in the image: the box of wrist,
/// thumb, knuckles and middle joints, twice as large (MediaPipe's hand_landmark_landmarks_to_roi).
Region region_of_landmarks(const Points& points_px);

/// From the middle of the palm's box, its larger side and the line from wrist to middle knuckle
/// (MediaPipe's palm_detection_detection_to_roi).
Region region_of_palm(glm::vec2 centre_px, glm::vec2 extent_px, glm::vec2 wrist_px,
                      glm::vec2 middle_knuckle_px);

glm::vec2 centre_of(const Points& points_px);
/// From the wrist to the middle knuckle.
float palm_length_px(const Points& points_px);
/// Mean distance point by point.
float distance_px(const Points& a, const Points& b);
bool is_finite(const Points& points_px);

}  // namespace handcast::landmarks
