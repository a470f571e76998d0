// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::landmarks {

/// `v` rotated by `angle_rad`, clockwise as seen in the image.
glm::vec2 turned(glm::vec2 v, float angle_rad);

/// A square of the image, turned so that the hand in it points up: the part that a network is
/// given.
struct Region {
  glm::vec2 centre_px{0};
  float size_px = 0;    ///< length of a side
  float angle_rad = 0;  ///< clockwise as seen in the image; 0: up is up

  /// From a place in the square to the image. `place` runs from -0.5 at the left and upper edge to
  /// 0.5 at the right and lower edge.
  glm::vec2 to_image(glm::vec2 place) const;
  /// The inverse of to_image().
  glm::vec2 to_place(glm::vec2 image_px) const;
};

/// The smallest upright square around the whole image.
Region region_of_image(int width_px, int height_px);

}  // namespace handcast::landmarks
