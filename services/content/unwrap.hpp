// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "calib/calibration.hpp"
#include "services/content/source.hpp"
#include "services/content/surface_map.hpp"

namespace handcast::content {

/// What looks at hands: the camera, or the projector, whose light takes the same way backwards.
struct Viewer {
  /// Size of its picture.
  /// @{
  int width_px = 0, height_px = 0;
  /// @}
  glm::vec3 centre_m{0};                                ///< camera space
  std::function<glm::vec2(const glm::vec3&)> pixel_of;  ///< of a place in camera space, z > 0
};

/// The camera, with the pixels of its image as the lens forms it.
Viewer viewer_of(const calib::CameraModel& lens);
/// The projector.
Viewer viewer_of(const calib::Calibration& calibration);

/// A texel of a hand that a viewer sees.
struct SeenTexel {
  std::size_t which;  ///< index into SurfaceMap::texels()
  glm::vec2 px;       ///< where it is seen, inside the picture
};

/// Finds the texels that a viewer sees: they face it, lie in its picture, and neither the hand
/// itself nor the other one is before them. `other` may be null. Nothing is seen of a hand without
/// a surface.
std::vector<SeenTexel> seen_texels(const Viewer& viewer, const SurfaceMap& map,
                                   const HandState& hand, const HandState* other);

}  // namespace handcast::content
