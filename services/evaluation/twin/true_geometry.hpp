// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "config/sections/twin/geometry.hpp"

namespace handcast::twin {

/// The rig as it is, where the calibration is only what the rig believes.
class TrueGeometry {
 public:
  /// Draws the errors of `believed` from the seed.
  TrueGeometry(const config::TwinGeometry& settings, int seed, const calib::Calibration& believed);

  /// The true camera, its homography at the distance where that holds, and the true tracker's pose.
  const calib::Calibration& calibration() const { return true_; }
  /// The projector pixel that lights a point in camera space, m. With N the point's place on the
  /// plane z = 1, c the projector's centre and d the distance at which the homography H holds:
  ///
  ///     H K (N - c (1 / z - 1 / d))
  glm::dvec2 to_projector(const glm::dvec3& camera_m) const;
  /// A pixel of the true camera's image, undistorted as the rig believes.
  glm::dvec2 believed_px(const glm::dvec2& image_px) const { return believed_.undistort(image_px); }

 private:
  calib::Calibration true_;
  calib::CameraModel believed_;
  glm::dvec2 centre_m_;  ///< of the projector, in camera space
  double plane_m_;
};

}  // namespace handcast::twin
