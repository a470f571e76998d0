// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/least_squares/normal_equations.hpp"
#include "calib/solve/screen/correspondence.hpp"

/// Least squares for ProjectorModel, which the fits of this folder share.
namespace handcast::calib {

/// A correspondence, ready for a fit.
struct Observation {
  glm::dvec2 camera_px{0};   ///< undistorted
  double inverse_depth = 0;  ///< 1/m; 1 / plane_m if only a homography is fitted
  glm::dvec2 projector_px{0};
  double sigma_px = 1;
  int block = 0;  ///< the part of the image and of the data that it belongs to
};

/// Which numbers of the model are unknown.
enum class Unknowns {
  homography = 8,   ///< a coaxial projector; parallax is 0
  everything = 11,  ///< any pinhole
};

/// Projector px by which the model misses an observation.
double residual_px(const ProjectorModel& model, const Observation& observation);

/// Levenberg-Marquardt on the residuals in standard deviations. `start` may be far off, but its
/// homography must be finite and of the right orientation. The result is not finite if the
/// observations do not determine the unknowns.
ProjectorModel refined(const ProjectorModel& start, std::span<const Observation> observations,
                       Unknowns unknowns);

/// The fits that other weights of the blocks would give: one Gauss-Newton step from the fit to all
/// of them. A step is exact up to the curvature of the model, which is small next to the noise, and
/// costs a small part of a fit.
class Replicas {
 public:
  /// `blocks`: one more than the highest block of the observations.
  Replicas(const ProjectorModel& best, std::span<const Observation> observations, Unknowns unknowns,
           int blocks);
  /// Nothing if these blocks do not determine the model. `weights`: one for each block.
  std::optional<ProjectorModel> with_weights(std::span<const double> weights) const;

  /// The fit is computed with centred and scaled coordinates (Hartley 1997).
  struct Scaling {
    glm::dmat3 camera{1}, projector{1};
    double inverse_depth = 1;
  };

 private:
  ProjectorModel best_;
  Unknowns unknowns_;
  Scaling scaling_;
  std::vector<NormalEquations> blocks_;
};

}  // namespace handcast::calib
