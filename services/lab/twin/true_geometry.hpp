// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "config/sections/twin/geometry.hpp"

namespace handcast::twin {

/// The map from the projective basis (three axes and their sum) to four points.
inline glm::dmat3 from_basis(const std::array<glm::dvec2, 4>& points) {
  const glm::dmat3 axes(glm::dvec3(points[0], 1), glm::dvec3(points[1], 1),
                        glm::dvec3(points[2], 1));
  const glm::dvec3 scale = glm::inverse(axes) * glm::dvec3(points[3], 1);
  return {axes[0] * scale.x, axes[1] * scale.y, axes[2] * scale.z};
}

/// The homography that maps each `from` to its `to`, of any scale. No three points may be on one
/// line.
inline glm::dmat3 homography(const std::array<glm::dvec2, 4>& from,
                             const std::array<glm::dvec2, 4>& to) {
  return from_basis(to) * glm::inverse(from_basis(from));
}

/// The rig as it is, where the calibration is only what the rig believes.
class TrueGeometry {
 public:
  /// Draws the differences of the true rig from `base` by the seed. `believed`: the camera by the
  /// rig's calibration.
  TrueGeometry(const config::TwinGeometry& settings, int seed, const calib::Calibration& base,
               const calib::CameraModel& believed);
  /// The same for a rig whose calibration is the base.
  TrueGeometry(const config::TwinGeometry& settings, int seed, const calib::Calibration& believed)
      : TrueGeometry(settings, seed, believed, believed.camera) {}

  /// The true camera, projector and tracker.
  const calib::Calibration& calibration() const { return true_; }
  /// The projector pixel that lights a point in camera space, m. A projector whose centre is at c
  /// has the parallax e = -H K c (calib::Calibration).
  glm::dvec2 to_projector(const glm::dvec3& camera_m) const;
  /// A pixel of the true camera's image, undistorted as the rig believes.
  glm::dvec2 believed_px(const glm::dvec2& image_px) const { return believed_.undistort(image_px); }

 private:
  calib::Calibration true_;
  calib::CameraModel believed_;
};

}  // namespace handcast::twin
