// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/landmarks.hpp"

/// Hands from two calibrated cameras (`docs/method.md#stereo`). Lengths are in metres, in the space
/// of the first camera (x right, y down, z forward); pixels are undistorted.
namespace handcast::pose::stereo {

inline constexpr int kViews = 2;  ///< cameras of a rig with pose.backend = "stereo"

/// One calibrated camera.
struct View {
  calib::CameraModel camera;      ///< its lens
  glm::dmat4 view_from_first{1};  ///< from the space of the first camera to its own; rigid
  static constexpr double kNearest_m = 0.05;  ///< what is nearer, or behind it, is not seen

  /// A point of the first camera's space in this camera's.
  glm::dvec3 in_view(const glm::dvec3& first_m) const {
    return glm::dvec3(view_from_first * glm::dvec4(first_m, 1));
  }
  /// The pixel of a point of the first camera's space. Points nearer than kNearest_m are projected
  /// as if they were that far away.
  glm::dvec2 project(const glm::dvec3& first_m) const;
};
using Views = std::array<View, kViews>;

/// The cameras of a calibration. Errors: bad_config (it has no second camera).
Result<Views> views_of(const calib::Calibration& calibration);

/// The 21 landmarks of a hand in one view, px.
using Points = std::array<glm::dvec2, msg::kLandmarks>;

}  // namespace handcast::pose::stereo
