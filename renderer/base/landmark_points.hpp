// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "ipc/msg/landmarks.hpp"

namespace handcast::renderer {

using msg::kLandmarks;
using LandmarkPoints =
    std::array<glm::vec2, kLandmarks>;  ///< undistorted camera px, MediaPipe's order

/// a - b, point by point.
inline LandmarkPoints difference(const LandmarkPoints& a, const LandmarkPoints& b) {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) points[i] = a[i] - b[i];
  return points;
}

/// a + b, point by point.
inline LandmarkPoints sum(const LandmarkPoints& a, const LandmarkPoints& b) {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) points[i] = a[i] + b[i];
  return points;
}

inline glm::vec2 position_px(const msg::Landmark& point) { return {point.x_px, point.y_px}; }

/// Its confidence is above 0 and its position finite.
inline bool was_seen(const msg::Landmark& point) {
  return point.confidence > 0 && std::isfinite(point.x_px) && std::isfinite(point.y_px);
}

}  // namespace handcast::renderer
