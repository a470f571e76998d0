// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "calib/calibration.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::pose::stereo {

// Hands from two calibrated cameras (`docs/method.md#stereo`). Lengths are in metres, in the space
// of the first camera (x right, y down, z forward); pixels are undistorted.

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

/// A point as one view sees it.
struct Sight {
  const View* view;  ///< must outlive the sight
  glm::dvec2 px;     ///< undistorted px
  double sigma_px;   ///< standard deviation of x and of y; above 0
};

/// A point in space and how well it is known.
struct SpacePoint {
  glm::dvec3 place_m{0};        ///< space of the first camera
  glm::dmat3 covariance_m2{0};  ///< of place_m, from the sigmas of the sights
  /// The sum of the squared residuals, in sigmas: of two views the squared distance between the
  /// point of one and the epipolar line of the other, over its variance.
  double misfit = 0;
};

/// The point whose projections are nearest to all sights, by their sigmas (Hartley & Zisserman
/// 2004, section 12.3, by Gauss-Newton from the point nearest to the rays). Empty with fewer than
/// two sights, nearly parallel rays, numbers that are not finite, or a point behind a camera.
std::optional<SpacePoint> triangulate(std::span<const Sight> sights);

}  // namespace handcast::pose::stereo
