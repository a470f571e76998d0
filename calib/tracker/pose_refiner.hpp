// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/tracker/tracker_path.hpp"

namespace handcast::calib {

/// The parameters: the tracker's pose, and how much later the tracker's clock shows a moment than
/// the camera's.
struct PoseAndOffset {
  glm::dmat4 camera_from_tracker{1};
  double offset_s = 0;
};

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

/// The parameters after a small step: rotation about the camera's axes (rad) through the centre of
/// the turned points, shift (m), offset (s).
PoseAndOffset stepped(const PoseAndOffset& from, const Vector7& step, const glm::dvec3& centre_m);

/// How one sighting differs from where the parameters put it.
struct Difference {
  glm::dvec2 error_px{0};                    ///< seen less expected
  Eigen::Matrix<double, 2, 7> slope;         ///< of the expected place, by stepped()
  double sigma_px = 1;
};
/// Empty if the tracker has no sample at that time, or the point is behind the camera.
std::optional<Difference> difference(const Sighting& seen, const TrackerPath& path,
                                     const CameraModel& camera, const PoseAndOffset& at,
                                     const glm::dvec3& centre_m);

/// The normal equations of weighted least squares: matrix * step = right.
struct NormalEquations {
  Matrix7 matrix = Matrix7::Zero();
  Vector7 right = Vector7::Zero();

  void add(const Difference& difference, double weight) {
    matrix += weight * difference.slope.transpose() * difference.slope;
    right += weight * difference.slope.transpose() *
             Eigen::Vector2d(difference.error_px.x, difference.error_px.y);
  }
  NormalEquations& operator+=(const NormalEquations& other) {
    matrix += other.matrix;
    right += other.right;
    return *this;
  }
  /// The step; zero if the equations do not determine it.
  Vector7 step() const;
};

/// Tukey's biweight: 1 for no error, 0 from `limit` on.
inline double tukey(double error, double limit) {
  const double u = error / limit;
  return u >= 1 ? 0 : (1 - u * u) * (1 - u * u);
}

/// Iteratively reweighted Gauss-Newton from `start`, with Tukey's weights at 4.7 robust standard
/// deviations (MAD).
PoseAndOffset refine(std::span<const Sighting> seen, const TrackerPath& path,
                     const CameraModel& camera, PoseAndOffset start, const glm::dvec3& centre_m);

/// Robust standard deviation (per axis) of distances in px: their median over that of a Rayleigh
/// distribution.
double robust_sigma_px(std::vector<double> distances_px);

}  // namespace handcast::calib
