// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::landmarks {

/// `v` rotated by `angle_rad`, clockwise as seen in the image.
glm::vec2 turned(glm::vec2 v, float angle_rad);

/// A square of the image, rotated so that the hand in it points up: the input of a network.
struct Region {
  glm::vec2 centre_px{0};  ///< centre of the square in the image
  float size_px = 0;       ///< length of a side
  float angle_rad = 0;     ///< clockwise as seen in the image; 0: up is up

  /// Converts a place in the square to the image. `place`: -0.5 at the left and upper edge to 0.5
  /// at the right and lower edge.
  glm::vec2 to_image(glm::vec2 place) const;
  /// The inverse of to_image().
  glm::vec2 to_place(glm::vec2 image_px) const;
};

/// The smallest upright square around the whole image.
Region region_of_image(int width_px, int height_px);

}  // namespace handcast::landmarks
