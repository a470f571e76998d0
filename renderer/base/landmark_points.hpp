// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "ipc/msg/landmarks.hpp"

namespace handcast::renderer {

using msg::kLandmarks;

/// The fingers, from the thumb to the little finger, and the landmarks of each, from its lowest
/// joint to its tip.
inline constexpr int kFingers = 5, kLandmarksOfFinger = 4;
/// The lowest landmark of a finger.
constexpr int first_landmark(int finger) { return 1 + kLandmarksOfFinger * finger; }
/// The finger of a landmark; -1 for the wrist.
constexpr int finger_of_landmark(int landmark) { return (landmark + 3) / kLandmarksOfFinger - 1; }

/// One position or displacement per landmark, in MediaPipe's order. Undistorted camera px, x right
/// and y down, unless another unit is stated. P, Q and Q̂ (`docs/method.md#symbols`) have this type.
using LandmarkPoints = std::array<glm::vec2, kLandmarks>;

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

/// The position of a detected landmark as a vector.
inline glm::vec2 position_px(const msg::Landmark& point) { return {point.x_px, point.y_px}; }

/// True if the landmark has a confidence above 0 and a position that a camera can see: the largest
/// image has 8192 pixels.
inline bool was_seen(const msg::Landmark& point) {
  constexpr float kFarthest_px = 1e5f;
  return point.confidence > 0 && std::abs(point.x_px) < kFarthest_px &&
         std::abs(point.y_px) < kFarthest_px;
}

}  // namespace handcast::renderer
