// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>

#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {

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
