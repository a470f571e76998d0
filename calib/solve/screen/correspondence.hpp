// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

namespace handcast::calib {

/// A place on a lit surface, as the camera sees it and as the projector lights it. Pixels: x to the
/// right, y down, (0, 0) is the centre of the top-left pixel.
struct Correspondence {
  glm::dvec2 camera_px{0};     ///< in the image as the lens forms it (distorted)
  glm::dvec2 projector_px{0};  ///< in the picture that is sent to the projector
  double sigma_px = 1;         ///< standard deviation of projector_px, in x and in y
};

}  // namespace handcast::calib
